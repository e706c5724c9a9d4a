#pragma once
// Progress of an estimation whose amount of work shows only on the way. Private to the room.

#include <algorithm>
#include <functional>
#include <mutex>

namespace coast::noise {

/// Each stage takes a share of what is left when it begins: a stage that has to be repeated moves more slowly, but forward.
class WorkProgress {
 public:
  using Tell = std::function<void(const char* what, double fraction)>;

  explicit WorkProgress(Tell tell) : tell_(std::move(tell)) {}

  /// The stages before have ended.
  void begin(double share_of_rest) {
    const std::scoped_lock lock(mutex_);
    begin_ = end_;
    end_ += share_of_rest * (1.0 - end_);
  }
  /// @param fraction  of the stage; from any thread
  void operator()(const char* what, double fraction) {
    if (!tell_) return;
    const std::scoped_lock lock(mutex_);
    done_ = std::max(done_, begin_ + std::clamp(fraction, 0.0, 1.0) * (end_ - begin_));
    tell_(what, done_);
  }

 private:
  std::mutex mutex_;
  Tell tell_;
  double begin_ = 0.0;
  double end_ = 0.0;
  double done_ = 0.0;
};

}  // namespace coast::noise
