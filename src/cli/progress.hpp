#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace coast::cli {

/// Reports on standard error the current stage, its progress and its remaining time; silent if `quiet` is set.
/// On a terminal it is one line that is rewritten. Elsewhere (a file, a pipe) it is a line when a stage begins for the first
/// time, and a line each `every` while the job lasts, also during a step without calls. Threads may call concurrently.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet, std::chrono::milliseconds every = std::chrono::seconds(30));
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// @param fraction  done of this stage, 0 to 1; 0 if unknown: then no remaining time is reported
  void show(const char* what, double fraction);
  /// `show`, for callers without this class; valid only during its lifetime.
  [[nodiscard]] std::function<void(const char*, double)> stages();
  /// Removes the line of a terminal, so that other text can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  void rewrite();
  void tell_now();
  void tell_regularly(const std::stop_token& stop, std::chrono::milliseconds every);
  [[nodiscard]] std::string standing() const;

  bool enabled_;
  bool terminal_;
  std::mutex mutex_;
  std::string what_ = "starting";
  double fraction_ = 0.0;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point since_;  ///< start of the stage
  Clock::time_point told_;
  std::size_t width_ = 0;  ///< of the line on the terminal
  std::set<std::string> begun_stages_;
  std::condition_variable_any stopped_;
  std::jthread regular_;  ///< last, so that it ends before the members that it uses
};

}  // namespace coast::cli
