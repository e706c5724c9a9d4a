#include "imu_builder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coast/record/error.hpp"

namespace coast::io {

namespace {

constexpr double kGapFactor = 1.5;  // samples are missing in a step longer than this many median intervals

/// Median step of the recording; of an even subset of at most 65536 steps if it is long.
double median_interval(const std::vector<record::ImuSample>& samples) {
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / 65536);
  std::vector<double> steps;
  steps.reserve(samples.size() / stride + 1);
  for (std::size_t i = 1; i < samples.size(); i += stride) steps.push_back(samples[i].t - samples[i - 1].t);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Number of samples over the covered time: with a clock of 1 ms resolution the median step does not give the rate.
double rate_without_gaps(const std::vector<record::ImuSample>& samples, double usual_interval) {
  double covered = 0.0;
  std::size_t steps = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step = samples[i].t - samples[i - 1].t;
    if (step > kGapFactor * usual_interval) continue;
    covered += step;
    ++steps;
  }
  return static_cast<double>(steps) / covered;
}

/// Gaps, counted for one event: the first and the longest place.
class GapLog {
 public:
  void add(geo::GpsTime from, double length) {
    if (count_ == 0) first_ = from;
    if (length > longest_) {
      longest_ = length;
      longest_at_ = from;
    }
    total_ += length;
    ++count_;
  }
  void report(const std::string& source, double interval, record::Events& events) const {
    if (count_ == 0) return;
    events.push_back({record::Event::Severity::kWarning, "imu_gap",
                      fmt::format("{}: {} step{} longer than {} sample intervals, {:.3f} s in all, the longest {:.3f} s at {}; "
                                  "bridged by linear rates",
                                  source, count_, count_ == 1 ? "" : "s", kGapFactor,
                                  total_ - interval * static_cast<double>(count_), longest_, geo::to_string(longest_at_)),
                      first_, count_});
  }

 private:
  long count_ = 0;
  double longest_ = 0.0;
  double total_ = 0.0;
  geo::GpsTime first_, longest_at_;
};

}  // namespace

void require_possible(const record::ImuSample& row, const WeekClock::MakeError& error) {
  constexpr double kImpossible = 1e6;
  const double gyro = row.dtheta.cwiseAbs().maxCoeff();
  const double accel = row.dv.cwiseAbs().maxCoeff();
  if (gyro < kImpossible && accel < kImpossible) return;
  throw error(fmt::format("{} of {:.3g} in SI units", gyro < kImpossible ? "a specific force" : "an angular rate",
                          gyro < kImpossible ? accel : gyro),
              "below 1e6", "Check columns, `units` and `scale`.");
}

void finish_imu(record::ImuRecording& recording, bool increments, TimeTag tag) {
  auto& samples = recording.samples;
  if (samples.size() < 2)
    throw InputError({recording.source, 0, fmt::format("{} IMU samples", samples.size()), "at least two", ""});
  const double interval = median_interval(samples);
  recording.rate_hz = rate_without_gaps(samples, interval);

  GapLog gaps;
  geo::GpsTime end_before = samples.front().t - interval;
  Eigen::Vector3d rate_before = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_before = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    record::ImuSample& s = samples[i];
    const double step = s.t - end_before;
    const bool gap = step > kGapFactor * interval;
    if (gap) gaps.add(end_before, step);
    // The interval measured by the sample itself; in the rest of a gap, the rate is linear from the sample before.
    const double own = gap ? interval : step;
    const Eigen::Vector3d rate = increments ? Eigen::Vector3d(s.dtheta / own) : s.dtheta;
    const Eigen::Vector3d force = increments ? Eigen::Vector3d(s.dv / own) : s.dv;
    s.dt = step;
    s.dtheta = rate * own;
    s.dv = force * own;
    if (gap) {
      s.dtheta += 0.5 * (rate_before + rate) * (step - own);
      s.dv += 0.5 * (force_before + force) * (step - own);
    }
    rate_before = rate;
    force_before = force;
    end_before = s.t;
  }
  gaps.report(recording.source, interval, recording.events);
  if (tag != TimeTag::kEnd) {
    const double shift = tag == TimeTag::kStart ? interval : 0.5 * interval;
    for (record::ImuSample& s : samples) s.t = s.t + shift;
  }
}

}  // namespace coast::io
