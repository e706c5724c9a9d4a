#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace coast::cli {

ProgressLine::ProgressLine(bool quiet) : enabled_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  clear();
}

void ProgressLine::show(const char* what, double fraction) {
  if (!enabled_) return;
  const auto now = std::chrono::steady_clock::now();
  if (what_ != what) {
    what_ = what;
    since_ = now;
  } else if (now - shown_ < std::chrono::milliseconds(100)) {
    return;
  }
  shown_ = now;
  const double elapsed = std::chrono::duration<double>(now - since_).count();
  std::string line = fmt::format("{} {:3.0f} %", what, 100.0 * fraction);
  if (fraction > 0.02 && elapsed > 1.0) line += fmt::format(", {:.0f} s left", elapsed * (1.0 - fraction) / fraction);
  std::fputs(fmt::format("\r{:<{}}", line, width_).c_str(), stderr);
  width_ = line.size();
}

void ProgressLine::clear() {
  if (!enabled_ || width_ == 0) return;
  std::fputs(fmt::format("\r{:<{}}\r", "", width_).c_str(), stderr);
  width_ = 0;
}

}  // namespace coast::cli
