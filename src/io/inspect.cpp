#include "coast/io/inspect.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "motion.hpp"

namespace coast::io {

namespace {

using Severity = record::Event::Severity;

void warn(Inspection& result, const char* kind, std::string text) {
  result.sentences.push_back(text);
  result.events.push_back({Severity::kWarning, kind, std::move(text), std::nullopt, 1});
}

double span(geo::GpsTime from, geo::GpsTime to) {
  return to - from;
}

constexpr double kTravelCorrelation = 0.6;
constexpr double kTimeCorrelation = 0.6;
constexpr double kGnssGap = 2.5;  // usual steps; receivers' logs jitter

/// Longest step and number of gaps.
struct Steps {
  double usual = 0.0;
  double longest = 0.0;
  long gaps = 0;
};

template <class Records>
Steps steps_of(const Records& records) {
  Steps s;
  std::vector<double> steps;
  for (std::size_t i = 1; i < records.size(); ++i) steps.push_back(records[i].t - records[i - 1].t);
  if (steps.empty()) return s;
  s.longest = *std::max_element(steps.begin(), steps.end());
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  s.usual = *middle;
  s.gaps = std::count_if(steps.begin(), steps.end(), [&](double step) { return step > kGnssGap * s.usual; });
  return s;
}

/// Equal up to the rounding of rate times interval.
bool same_rates(const record::ImuSample& a, const record::ImuSample& b) {
  constexpr double kRounding = 1e-12;
  return (a.dtheta / a.dt).isApprox(b.dtheta / b.dt, kRounding) && (a.dv / a.dt).isApprox(b.dv / b.dt, kRounding);
}

void describe_imu(const record::ImuRecording& imu, Inspection& result) {
  const auto& samples = imu.samples;
  long gaps = 0;
  double longest = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    longest = std::max(longest, samples[i].dt);
    if (samples[i].dt * imu.rate_hz > 1.5) ++gaps;
    if (i > 0 && same_rates(samples[i - 1], samples[i])) ++result.repeated_samples;
  }
  result.sentences.push_back(fmt::format(
      "IMU: {} samples over {:.2f} s at {:.2f} Hz, {} to {}; {}.", samples.size(), span(samples.front().t, samples.back().t),
      imu.rate_hz, geo::to_string(samples.front().t), geo::to_string(samples.back().t),
      gaps == 0 ? "no gap" : fmt::format("{} gap{}, the longest step {:.3f} s", gaps, gaps == 1 ? "" : "s", longest)));
  const double share = static_cast<double>(result.repeated_samples) / static_cast<double>(samples.size());
  const auto text = fmt::format("{} IMU samples ({:.1f} %) repeat the one before: the sensor's output is slower than the log.",
                                result.repeated_samples, 100.0 * share);
  if (share > 0.1)
    warn(result, "imu_repeated_samples", text);
  else if (result.repeated_samples > 0)
    result.sentences.push_back(text);
}

void describe_gnss(const record::GnssRecording& gnss, Inspection& result) {
  const auto& fixes = gnss.fixes;
  const Steps steps = steps_of(fixes);
  const auto velocities = std::count_if(fixes.begin(), fixes.end(), [](const auto& f) { return f.velocity.has_value(); });
  result.sentences.push_back(fmt::format(
      "GNSS: {} fixes over {:.2f} s, one every {:.3g} s, {} to {}; {}; {}.", fixes.size(),
      span(fixes.front().t, fixes.back().t), steps.usual, geo::to_string(fixes.front().t), geo::to_string(fixes.back().t),
      steps.gaps == 0 ? "no gap"
                      : fmt::format("{} gap{}, the longest {:.2f} s", steps.gaps, steps.gaps == 1 ? "" : "s", steps.longest),
      velocities == 0 ? "no velocities" : fmt::format("{} with velocity", velocities)));
  static constexpr std::array<const char*, 7> kNames = {
      "of unknown quality", "fixed", "float", "SBAS", "DGPS", "single", "PPP"};
  std::array<long, 7> count{};
  std::vector<double> horizontal, vertical;
  for (const auto& fix : fixes) {
    ++count[static_cast<std::size_t>(fix.quality)];
    horizontal.push_back(std::sqrt(0.5 * (fix.position_cov_n(0, 0) + fix.position_cov_n(1, 1))));
    vertical.push_back(std::sqrt(fix.position_cov_n(2, 2)));
  }
  std::string shares;
  for (std::size_t i = 0; i < count.size(); ++i)
    if (count[i] > 0)
      shares += fmt::format("{}{:.1f} % {}", shares.empty() ? "" : ", ",
                            100.0 * static_cast<double>(count[i]) / static_cast<double>(fixes.size()), kNames[i]);
  const auto range = [](std::vector<double>& v) {
    std::sort(v.begin(), v.end());
    return fmt::format("{:.3g} to {:.3g} m, median {:.3g} m", v.front(), v.back(), v[v.size() / 2]);
  };
  result.sentences.push_back(fmt::format("Quality: {}. Stated sigma per axis: horizontal {}; vertical {}.", shares,
                                         range(horizontal), range(vertical)));
}

/// Possible causes of a size of the specific force that is not gravity.
std::string size_hint(double ratio, double rate_hz) {
  const auto near = [&](double value) { return ratio > 0.8 * value && ratio < 1.25 * value; };
  if (near(1.0 / geo::kStandardGravity)) return " It looks like g: set `units: {accel: g}`.";
  if (near(geo::kStandardGravity)) return " It is a factor of g too large: it is in m/s^2 already.";
  if (near(1.0 / rate_hz)) return " It looks like increments: set `values: increments`.";
  if (near(rate_hz)) return " It looks like rates: set `values: rates`.";
  return " Check `units`, `scale` and `values`.";
}

std::string axis_name(const Eigen::Vector3d& direction) {
  Eigen::Index i = 0;
  direction.cwiseAbs().maxCoeff(&i);
  return fmt::format("{}{}", direction[i] < 0.0 ? "-" : "", "xyz"[i]);
}

Eigen::Vector3d nearest_axis(const Eigen::Vector3d& direction) {
  Eigen::Index i = 0;
  direction.cwiseAbs().maxCoeff(&i);
  return Eigen::Vector3d::Unit(i) * (direction[i] < 0.0 ? -1.0 : 1.0);
}

/// `axes:` so that the axis along `down` points down, and the one along `forward` forward.
std::string axes_mapping(const Eigen::Vector3d& down, const Eigen::Vector3d& forward) {
  const Eigen::Vector3d d = nearest_axis(down);
  const Eigen::Vector3d f = nearest_axis(forward - d.dot(forward) * d);
  return fmt::format("axes: [{}, {}, {}]", axis_name(f), axis_name(d.cross(f)), axis_name(d));
}

bool check_force(const record::ImuRecording& imu, const RestForce& rest, double gravity, Inspection& result) {
  result.f_rest = rest.force;
  result.rest_seen = rest.seen;
  result.gravity = gravity;
  const double norm = rest.force.norm();
  const auto text = fmt::format(
      "{}: specific force ({:.3f}, {:.3f}, {:.3f}) m/s^2, size {:.3f} against {:.3f} of gravity here "
      "({:+.1f} %).",
      rest.seen ? fmt::format("At rest ({:.0f} s)", rest.seconds) : "No standstill seen; quietest seconds", rest.force.x(),
      rest.force.y(), rest.force.z(), norm, gravity, 100.0 * (norm / gravity - 1.0));
  if (norm < 0.7 * gravity || norm > 1.4 * gravity) {
    warn(result, "specific_force_unit", text + size_hint(norm / gravity, imu.rate_hz));
    return false;
  }
  result.sentences.push_back(text);
  if (std::abs(norm / gravity - 1.0) > 0.02)
    warn(result, "specific_force_size",
         fmt::format("The size differs by more than 2 %: a bias or scale error to be estimated, or a "
                     "wrong unit."));
  return true;
}

void check_axes(const Eigen::Vector3d& f_rest, const std::optional<TravelDirection>& travel, Inspection& result) {
  const Eigen::Vector3d down = -f_rest.normalized();
  const bool travel_known = travel && travel->correlation > kTravelCorrelation;
  const Eigen::Vector3d forward =
      travel_known
          ? travel->forward
          : Eigen::Vector3d(nearest_axis(down).cwiseAbs().x() > 0.5 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX());
  const std::string choice = travel_known ? "" : " (which axis is forward was not seen: turn it about the vertical as mounted)";
  if (down.z() < -0.7) {
    warn(result, "gravity_sign",
         fmt::format("At rest z reads {:+.2f} m/s^2, so z points up; forward-right-down has it at -9.8. The axes look like "
                     "forward-left-up or another z-up frame: set `{}`{}.",
                     f_rest.z(), axes_mapping(down, forward), choice));
  } else if (down.z() < 0.7) {
    warn(result, "gravity_axis",
         fmt::format("At rest gravity is not along z: {} points down. Set `{}`{}.", axis_name(down),
                     axes_mapping(down, forward), choice));
  } else if (travel_known && std::abs(travel->yaw) > 30.0 * geo::kDegree) {
    warn(result, "travel_direction",
         fmt::format(
             "Accelerations and turns fit a direction of travel {:.0f} deg from x, clockwise (correlation {:.2f}): if the "
             "vehicle drives forward, set `{}`.",
             travel->yaw / geo::kDegree, travel->correlation, axes_mapping(down, forward)));
  } else {
    result.sentences.push_back(fmt::format("Axes: z points down, as forward-right-down has it{}.",
                                           travel_known ? fmt::format("; the direction of travel is {:+.1f} deg from x "
                                                                      "(clockwise, correlation {:.2f})",
                                                                      travel->yaw / geo::kDegree, travel->correlation)
                                                        : ""));
  }
}

/// Integer-second differences between time scales that are often confused, and their names.
/// @param step  between fixes, s: turns are matched within one
const char* scale_of(double shift, double step) {
  const double s = std::abs(shift);
  const double whole = std::round(s);
  if (std::abs(s - whole) > 0.3) return nullptr;
  if (whole >= 13.0 && whole <= 18.0) return "GPS minus UTC (leap seconds; 18 s since 2017, fewer before)";
  if (whole == 19.0)
    return step < 0.6 ? "TAI minus GPS"
                      : "GPS minus UTC (leap seconds, 18 s), or TAI minus GPS (19 s): fixes this far apart do not tell which";
  if (whole >= 32.0 && whole <= 37.0) return "TAI minus UTC";
  return nullptr;
}

void check_time(const TimeMatch& match, double step, Inspection& result) {
  result.time_correlation = match.correlation;
  const double strength = std::abs(match.correlation);
  if (strength < kTimeCorrelation) {
    // No warning: a drone or a boat in a current may not move along its own axis.
    result.sentences.push_back(fmt::format(
        "Times: the course of GNSS does not follow the turns of the IMU at any shift within 45 s (correlation {:.2f}): a "
        "vehicle that does not move along its own axis, or times further apart.",
        strength));
    return;
  }
  result.time_shift_s = match.shift;
  result.gyro_slope = match.slope;
  if (std::abs(match.shift) < 0.15) {
    result.sentences.push_back(
        fmt::format("Times: turns of GNSS and IMU match within 0.15 s (best at {:+.2f} s, correlation {:.3f}).", match.shift,
                    match.correlation));
  } else if (const char* scale = scale_of(match.shift, step)) {
    warn(result, "leap_second_shift",
         fmt::format(
             "GNSS times are {:+.2f} s from those of the IMU (correlation {:.3f} there, {:.2f} unshifted): that is {}. One of "
             "the files is not in the time scale stated for it: set `time: {{kind: utc}}` or `offset_s` there.",
             -match.shift, match.correlation, match.correlation_unshifted, scale));
  } else {
    warn(result, "time_shift",
         fmt::format("Turns match best when GNSS times are shifted by {:+.2f} s (correlation {:.3f}, {:.2f} unshifted): set "
                     "`gnss.time_offset_s: {:.2f}`.",
                     match.shift, match.correlation, match.correlation_unshifted, -match.shift));
  }
  const double slope = match.slope;
  if (slope < 0.0)
    warn(result, "gyro_sign",
         fmt::format("The gyro about the vertical turns against the course (slope {:.2f}): a sign, left-handed "
                     "axes, or latitude and longitude (north and east) exchanged.",
                     slope));
  else if (slope < 0.1 || slope > 10.0)
    warn(result, "gyro_unit",
         fmt::format(
             "The gyro reads {:.3g} times the course rate: check `units: {{gyro: ..}}` (deg/s for rad/s would be {:.3g}).",
             slope, slope > 1.0 ? 1.0 / geo::kDegree : geo::kDegree));
}

void check_overlap(const record::ImuRecording& imu, const record::GnssRecording& gnss, Inspection& result) {
  const geo::GpsTime from = std::max(imu.samples.front().t - imu.samples.front().dt, gnss.fixes.front().t);
  const geo::GpsTime to = std::min(imu.samples.back().t, gnss.fixes.back().t);
  result.overlap_s = std::max(0.0, to - from);
  if (to <= from) {
    const double apart = from - to;
    warn(result, "no_overlap",
         fmt::format("IMU and GNSS have no common time: {:.1f} s ({:.2f} days) lie between them. Check `gps_week` "
                     "and `time`.",
                     apart, apart / 86400.0));
    return;
  }
  const double shorter =
      std::min(span(imu.samples.front().t, imu.samples.back().t), span(gnss.fixes.front().t, gnss.fixes.back().t));
  const auto text =
      fmt::format("Common interval: {:.2f} s, {} to {}.", result.overlap_s, geo::to_string(from), geo::to_string(to));
  if (result.overlap_s < 0.5 * shorter)
    warn(result, "short_overlap", text + " That is less than half of the shorter recording.");
  else
    result.sentences.push_back(text);
}

}  // namespace

Inspection inspect(const record::GnssRecording& gnss) {
  Inspection result;
  if (!gnss.fixes.empty()) describe_gnss(gnss, result);
  return result;
}

Inspection inspect(const record::ImuRecording& imu) {
  Inspection result;
  if (imu.samples.empty()) return result;
  describe_imu(imu, result);
  const ImuMeans means(imu);
  if (const auto rest = rest_force(means, {})) check_force(imu, *rest, geo::kStandardGravity, result);
  return result;
}

Inspection inspect(const record::ImuRecording& body, const record::GnssRecording& gnss) {
  Inspection result;
  if (body.samples.empty() || gnss.fixes.empty()) return result;
  describe_imu(body, result);
  describe_gnss(gnss, result);
  check_overlap(body, gnss, result);
  const ImuMeans means(body);
  const auto legs = gnss_legs(gnss, means.origin());
  const auto rest = rest_force(means, legs);
  if (!rest || rest->force.norm() == 0.0) return result;
  const double gravity = geo::gravity_e(gnss.fixes.front().r_ea_e).norm();
  if (!check_force(body, *rest, gravity, result)) return result;
  const auto match = match_time(means, legs, -rest->force.normalized());
  const bool matched = match && std::abs(match->correlation) >= kTimeCorrelation;
  const auto travel = travel_direction(means, legs, matched ? match->shift : 0.0, rest->force);
  if (travel && travel->correlation > kTravelCorrelation && -rest->force.z() > 0.7 * rest->force.norm())
    result.travel_yaw = travel->yaw;
  check_axes(rest->force, travel, result);
  if (match)
    check_time(*match, (gnss.fixes.back().t - gnss.fixes.front().t) / static_cast<double>(gnss.fixes.size()), result);
  else
    result.sentences.emplace_back("Times: not enough turning at speed to compare the clocks of GNSS and IMU.");
  return result;
}

}  // namespace coast::io
