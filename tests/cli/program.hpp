#pragma once
// The program as a user runs it: exit status, messages, files.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/short_drive.hpp"

namespace coast::cli {

struct Outcome {
  int status;
  std::string error;  ///< standard error
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline Outcome run(const std::string& arguments, const std::filesystem::path& folder) {
  const std::filesystem::path log = folder / "stderr.txt";
  const std::string command =
      fmt::format("'{}' {} >'{}' 2>'{}'", COAST_PROGRAM, arguments, (folder / "stdout.txt").string(), log.string());
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(log)};
}

inline void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// Simulates a scenario whose error model is model.yaml. @return the folder of the recording, inside `folder`
inline std::filesystem::path simulated_recording(const std::string& scenario, const std::filesystem::path& folder) {
  write(folder / "scenario.yaml", scenario);
  write(folder / "model.yaml", test::kTestModel);
  const Outcome outcome =
      run(fmt::format("simulate '{}' --out '{}'", (folder / "scenario.yaml").string(), (folder / "rec").string()), folder);
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  return folder / "rec";
}

}  // namespace coast::cli
