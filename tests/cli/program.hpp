#pragma once
// The program as a user runs it: exit status, messages, files.

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

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

}  // namespace coast::cli
