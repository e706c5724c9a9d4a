#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace coast::cli {

namespace {

double seconds_from(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

ProgressLine::ProgressLine(bool quiet, std::chrono::milliseconds every)
    : enabled_(!quiet), terminal_(::isatty(STDERR_FILENO) == 1) {
  if (enabled_ && !terminal_)
    regular_ = std::jthread([this, every](const std::stop_token& stop) { tell_regularly(stop, every); });
}

ProgressLine::~ProgressLine() {
  clear();
}

void ProgressLine::show(const char* what, double fraction) {
  if (!enabled_) return;
  const std::scoped_lock lock(mutex_);
  fraction_ = fraction;
  const bool begins = what_ != what;
  if (begins) {
    what_ = what;
    since_ = Clock::now();
  }
  if (terminal_) {
    if (begins || Clock::now() - told_ >= std::chrono::milliseconds(100)) rewrite();
  } else if (begins && begun_stages_.insert(what_).second) {  // a repeated stage would fill the file
    tell_now();
  }
}

std::function<void(const char*, double)> ProgressLine::stages() {
  return [this](const char* what, double fraction) { show(what, fraction); };
}

std::string ProgressLine::standing() const {
  if (!(fraction_ > 0.0)) return what_;
  const double elapsed = seconds_from(since_);
  std::string text = fmt::format("{} {:.0f} %", what_, 100.0 * fraction_);
  if (fraction_ > 0.02 && elapsed > 1.0) text += fmt::format(", {:.0f} s left", elapsed * (1.0 - fraction_) / fraction_);
  return text;
}

void ProgressLine::rewrite() {
  told_ = Clock::now();
  const std::string line = standing();
  std::fputs(fmt::format("\r{:<{}}", line, width_).c_str(), stderr);
  width_ = line.size();
}

void ProgressLine::tell_now() {
  told_ = Clock::now();
  std::fputs(fmt::format("{:4.0f} s: {}\n", seconds_from(begun_), standing()).c_str(), stderr);
}

void ProgressLine::tell_regularly(const std::stop_token& stop, std::chrono::milliseconds every) {
  std::unique_lock lock(mutex_);
  told_ = Clock::now();
  while (!stop.stop_requested()) {
    stopped_.wait_until(lock, stop, told_ + every, [] { return false; });  // woken only by the end
    if (!stop.stop_requested() && Clock::now() - told_ >= every) tell_now();
  }
}

void ProgressLine::clear() {
  const std::scoped_lock lock(mutex_);
  if (width_ == 0) return;
  std::fputs(fmt::format("\r{:<{}}\r", "", width_).c_str(), stderr);
  width_ = 0;
}

}  // namespace coast::cli
