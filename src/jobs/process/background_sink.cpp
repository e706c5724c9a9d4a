#include "process/background_sink.hpp"

#include <utility>

namespace coast::jobs {

namespace {
constexpr std::size_t kBatch = 4096;  // epochs, 1.2 MB: work for some milliseconds
}  // namespace

BackgroundSink::BackgroundSink(record::EpochSink sink) : sink_(std::move(sink)) {
  filling_.reserve(kBatch);
  emptying_.reserve(kBatch);
}

BackgroundSink::~BackgroundSink() {
  try {
    work_.wait();
  } catch (...) {  // another exception is being thrown already
  }
}

void BackgroundSink::add(const record::TrajectoryEpoch& epoch) {
  filling_.push_back(epoch);
  if (filling_.size() == kBatch) hand_over();
}

void BackgroundSink::finish() {
  hand_over();
  work_.wait();
}

void BackgroundSink::hand_over() {
  work_.wait();
  std::swap(filling_, emptying_);
  filling_.clear();
  work_.run([this] {
    for (const record::TrajectoryEpoch& epoch : emptying_) sink_(epoch);
  });
}

}  // namespace coast::jobs
