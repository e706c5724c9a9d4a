#pragma once
// The subcommands with their options: one table, for parsing, for --help, for the manual pages and for completions.

#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "commands.hpp"

namespace coast::cli {

class CommandLine {
 public:
  CommandLine();
  CommandLine(const CommandLine&) = delete;  // callbacks refer to its values
  CommandLine& operator=(const CommandLine&) = delete;

  [[nodiscard]] CLI::App& app() { return app_; }
  /// Calls the subcommand.
  /// @throws CLI::ParseError  wrong options, or help was asked for; InputError  no subcommand of that name; what the subcommand
  ///                          throws
  void parse(int argc, char** argv);

 private:
  CLI::App app_;
  CommonOptions common_;
  std::filesystem::path input_, other_;
  std::optional<std::uint64_t> seed_;
  std::vector<double> lever_arm_{0.0, 0.0, 0.0};
  DiagnoseOptions diagnose_;
  ConvertOptions convert_;
  CampaignOptions campaign_;
  std::optional<int> gps_week_;
  std::optional<tbb::global_control> limit_;  ///< of threads, while the subcommand runs
};

}  // namespace coast::cli
