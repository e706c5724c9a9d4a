#include "defect_watch.hpp"

#include <algorithm>
#include <cmath>

namespace coast::array {

namespace {

std::size_t members_of(const ChannelWindows::Set& set) {
  return static_cast<std::size_t>(std::count(set.begin(), set.end(), true));
}

}  // namespace

DefectWatch::DefectWatch(ChannelWindows& windows, std::size_t blocks, int channel, std::size_t recovery)
    : windows_(windows), blocks_(blocks), channel_(channel), recovery_(recovery) {}

void DefectWatch::run() {
  const std::size_t sensors = windows_.sensors();
  in_order_.assign(sensors, true);
  in_order_from_.assign(sensors, 0);
  windows_from_ = in_order_from_;
  trials_.assign(sensors, {});
  learn();
  windows_.fit_learnt();
  for (std::size_t b = 0; b < blocks_; ++b) step(b);
  for (std::size_t k = 0; k < sensors; ++k)
    if (trials_[k]) alarms_[trials_[k]->alarm].back = blocks_;
}

/// Learning pass. The level follows a jump: after it the sensor is in order again.
void DefectWatch::learn() {
  const ChannelWindows::Set all(windows_.sensors(), true);
  for (std::size_t b = 0; b < blocks_; ++b) {
    const ChannelWindows::Set set = there(b);
    windows_.enter(b, set);
    windows_.learn(b, set, in_order_from_);
    for (std::size_t k = 0; k < set.size(); ++k) {
      if (!set[k]) continue;
      const TestValue test = windows_.largest(k, set, in_order_from_);
      if (test.kind == TestValue::Kind::kLevel && test.excess > 1.0) windows_.follow(k, test.window, set, in_order_from_);
    }
    windows_.absorb(b, all, in_order_from_);
  }
}

ChannelWindows::Set DefectWatch::there(std::size_t b) const {
  ChannelWindows::Set set = in_order_;
  for (std::size_t k = 0; k < set.size(); ++k) set[k] = set[k] && windows_.has(k, b);
  return set;
}

/// Excludes the sensor with the largest test, then repeats without it, while there are three sensors to identify it.
void DefectWatch::step(std::size_t b) {
  for (;;) {
    const ChannelWindows::Set set = there(b);
    windows_.enter(b, set);
    std::size_t worst = 0;
    TestValue test;
    for (std::size_t k = 0; k < set.size(); ++k) {
      if (!set[k]) continue;
      const TestValue own = windows_.largest(k, set, windows_from_);
      if (own.excess > test.excess) {
        test = own;
        worst = k;
      }
    }
    if (test.excess <= 1.0) break;
    if (members_of(set) < 3) {
      contradict(set, b, test);
      break;
    }
    if (!stands_out(worst, set, test)) break;
    leave(worst, b, test);
  }
  for (std::size_t k = 0; k < trials_.size(); ++k)
    if (trials_[k] && trials_[k]->since <= b) follow_trial(k, b);
  windows_.absorb(b, in_order_, in_order_from_);
}

/// Where the others contradict one another too, all are disturbed at once (an impact, vibration) and none is accused. One more
/// sensor may be defective at the same time.
bool DefectWatch::stands_out(std::size_t k, ChannelWindows::Set set, const TestValue& test) {
  constexpr double kInOrder = 0.5;  // of a threshold of some six standard deviations
  constexpr double kTimesTheOthers = 10.0;
  const double in_order = std::max(kInOrder, test.excess / kTimesTheOthers);
  set[k] = false;
  const SensorTest second = windows_.largest_among(set, windows_from_);
  if (second.test.excess < in_order) return true;
  if (second.test.excess < 1.0) return false;
  set[second.sensor] = false;
  return members_of(set) >= 3 && windows_.largest_among(set, windows_from_).test.excess < in_order;
}

void DefectWatch::leave(std::size_t k, std::size_t b, const TestValue& test) {
  Alarm alarm;
  alarm.sensor = k;
  alarm.channel = channel_;
  alarm.found = b;
  alarm.statistic = test.statistic;
  alarm.onset = onset_of(k, b, test);
  in_order_[k] = false;
  constexpr std::size_t kBefore = 50;  // blocks: one may be a peak
  Trial trial;
  trial.since = b + 1;
  trial.alarm = alarms_.size();
  if (test.kind == TestValue::Kind::kNoise)
    trial.most_noise = std::sqrt(test.ratio);
  else
    trial.needs_power = windows_.power(b > kBefore ? b - kBefore : 0, b);
  trials_[k] = trial;
  alarms_.push_back(alarm);
  // The windows of the others contain residuals relative to the one that was excluded.
  std::fill(windows_from_.begin(), windows_from_.end(), b + 1);
}

void DefectWatch::contradict(const ChannelWindows::Set& set, std::size_t b, const TestValue& test) {
  Disagreement record;
  record.channel = channel_;
  record.a = static_cast<std::size_t>(std::find(set.begin(), set.end(), true) - set.begin());
  record.b = set.size() - 1 - static_cast<std::size_t>(std::find(set.rbegin(), set.rend(), true) - set.rbegin());
  record.found = b;
  record.statistic = test.statistic;
  const bool known = !disagreements_.empty() && disagreements_.back().found + recovery_ > b;
  if (!known) disagreements_.push_back(record);
  if (test.kind == TestValue::Kind::kLevel) windows_.move_to(record.b, test.window, set, windows_from_);
  std::fill(windows_from_.begin(), windows_from_.end(), b + 1);
  in_order_from_[record.b] = b + 1;
}

/// After enough blocks in order: used again, from the beginning of that time. A sensor found in motion that is at its old level
/// with less motion may still be defective: it waits for motion. At a new level the defect was the level.
void DefectWatch::follow_trial(std::size_t k, std::size_t b) {
  Trial& trial = *trials_[k];
  if (!windows_.has(k, b) || windows_.residual_variance(k, b) == 0.0 ||
      windows_.largest_on_trial(k, trial.since).excess > 1.0) {
    trial.since = b + 1;
    trial.in_motion = 0.0;
    return;
  }
  constexpr double kOtherLevel = 4.0;  // standard deviations
  trial.in_motion += trial.needs_power > 0.0 ? std::min(1.0, 2.0 * windows_.power(b, b) / trial.needs_power) : 1.0;
  if (b + 1 - trial.since < recovery_) return;
  if (trial.most_noise > 0.0 && windows_.noise_since(k, trial.since) > trial.most_noise) {
    ++trial.since;  // weak noise below the threshold of short windows: the last seconds have to be quiet together
    return;
  }
  const bool moved = trial.in_motion >= static_cast<double>(recovery_);
  if (!moved && windows_.shift_of_level(k, trial.since) < kOtherLevel) return;
  windows_.take_back(k, trial.since, b);
  alarms_[trial.alarm].back = trial.since;
  in_order_[k] = true;
  in_order_from_[k] = b + 1;
  windows_from_[k] = b + 1;
  trials_[k].reset();
}

/// Log-likelihood ratio of a constant from `from` on against none.
double DefectWatch::jump_score(std::size_t k, std::size_t from, std::size_t b) const {
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = from; i <= b; ++i) {
    const double variance = windows_.residual_variance(k, i);
    if (variance <= 0.0) continue;
    sum += windows_.residual(k, i) / variance;
    weights += 1.0 / variance;
  }
  return weights > 0.0 ? sum * sum / weights / 2.0 : 0.0;
}

/// Likewise for a larger variance.
double DefectWatch::burst_score(std::size_t k, std::size_t from, std::size_t b, bool of_samples) const {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = from; i <= b; ++i) {
    const double variance = windows_.residual_variance(k, i);
    if (variance <= 0.0) continue;
    sum += of_samples ? windows_.roughness_ratio(k, i) : windows_.residual(k, i) * windows_.residual(k, i) / variance;
    count += 1.0;
  }
  const double ratio = count > 0.0 ? sum / count : 0.0;
  if (ratio <= 1.0) return 0.0;
  return count * (of_samples ? windows_.dof(k) : 1.0) / 2.0 * (ratio - 1.0 - std::log(ratio));
}

/// The likeliest start within two windows before the detection.
std::size_t DefectWatch::onset_of(std::size_t k, std::size_t b, const TestValue& test) const {
  constexpr std::size_t kMargin = 10;
  const std::size_t window = test.kind == TestValue::Kind::kLevel   ? kLevelWindows[test.window]
                             : test.kind == TestValue::Kind::kNoise ? kNoiseWindows[test.window]
                                                                    : kMotionWindows[test.window];
  const std::size_t reach = 2 * window + kMargin;
  const std::size_t first = std::max(in_order_from_[k], b > reach ? b - reach : 0);
  std::size_t best = b;
  double most = -1.0;
  for (std::size_t from = first; from <= b; ++from) {
    const double score = test.kind == TestValue::Kind::kLevel ? jump_score(k, from, b)
                                                              : burst_score(k, from, b, test.kind == TestValue::Kind::kNoise);
    if (score > most) {
      most = score;
      best = from;
    }
  }
  return best;
}

}  // namespace coast::array
