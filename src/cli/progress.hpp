#pragma once

#include <chrono>
#include <string>

namespace coast::cli {

/// One line on the terminal that is rewritten: what is being done, how far, time left. Silent where standard error is no
/// terminal or `quiet` is set.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void show(const char* what, double fraction);
  /// Removes the line, so that other text can be printed.
  void clear();

 private:
  bool enabled_;
  std::string what_;
  std::chrono::steady_clock::time_point since_;
  std::chrono::steady_clock::time_point shown_;
  std::size_t width_ = 0;
};

}  // namespace coast::cli
