#pragma once
// What is in a file: kind, span, rates, satellites and signals, gaps, messages, damage.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/jobs/job.hpp"

namespace coast::jobs {

struct InspectConfig {
  /// Any file of a recording that coast reads, tables with the default columns; or a run file, whose recordings are then read
  /// with its columns, axes and units.
  std::filesystem::path file;
  std::optional<int> gps_week;  ///< of files with seconds of week only
};

struct InspectResult {
  /// One kind of content, e.g. "observations".
  struct Section {
    std::string title;
    std::vector<std::string> lines;
  };
  std::string format;  ///< "UBX of u-blox receivers"
  std::vector<Section> sections;
  std::vector<std::string> warnings;  ///< repairs and damage, a sentence each
  std::vector<std::string> absent;    ///< what the format could hold and the file does not
};

/// @throws InputError  the file is of no kind that coast reads, or nothing in it can be read; a run file that has errors
[[nodiscard]] InspectResult inspect(const InspectConfig& config, const Progress& progress);
/// The lines for a terminal.
[[nodiscard]] std::string told(const InspectConfig& config, const InspectResult& result);

}  // namespace coast::jobs
