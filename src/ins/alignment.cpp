#include "coast/ins/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/gap.hpp"
#include "coast/ins/strapdown.hpp"
#include "coast/record/error.hpp"
#include "force_match.hpp"
#include "gnss_track.hpp"
#include "start_point.hpp"

namespace coast::ins {
namespace {

constexpr double kShortGap = 0.1;                                // s: in shorter gaps a body rotates little
constexpr double kGoodHeading = 1.0 * geo::kDegree;              // the search for a better window ends
constexpr double kFairHeading = 5.0 * geo::kDegree;              // accepted if `kPatience` gave none better
constexpr double kPatience = 60.0;                               // s
constexpr double kGyrocompass = 2.0 * geo::kDegree;              // if better than this, no motion is required
constexpr double kUsableHeading = 15.0 * geo::kDegree;           // a filter linear in the attitude converges from here
constexpr double kClearLead = 6.0;                               // -2 log likelihood: another heading is 20 times less likely
constexpr double kSearch = 600.0, kSearchStep = 20.0;            // s
constexpr double kShortestWindow = 10.0, kLongestWindow = 80.0;  // s
constexpr double kIntervals = 12.0;                              // number of fix intervals in the longest window, at least
constexpr double kStandstillVelocitySd = 0.02;                   // m/s; engines vibrate, rotors lift
constexpr double kForceError = 0.02;                             // m/s^2, of attitude and accelerometer bias together
constexpr double kMinForceBias = 1e-3;  // m/s^2; smaller than the error of any accelerometer, and of gravity
constexpr double kLeastBiasSd = 1e-5;   // rad/s; a vehicle at rest on wheels or legs may still rotate by this

const char* const kGiveStart =
    "Give the state under `start:` (time_s, position_deg_m, velocity_mps, attitude_deg, sd), or start the recording earlier or "
    "later.";

struct Span {
  std::size_t first = 0;  // sample whose time tag is the start of the mission
  geo::GpsTime t;
  geo::GpsTime end;
};

Span common_span(const AlignmentInput& input) {
  const auto& samples = input.imu.samples;
  const auto& fixes = input.gnss.fixes;
  if (samples.empty() || fixes.size() < 3)
    throw NumericalError(
        "initial state", "",
        fmt::format("{} IMU samples and {} GNSS fixes, too few. {}", samples.size(), fixes.size(), kGiveStart));
  const auto first = std::lower_bound(samples.begin(), samples.end(), fixes.front().t,
                                      [](const record::ImuSample& sample, geo::GpsTime t) { return sample.t < t; });
  const geo::GpsTime end = std::min(samples.back().t, fixes.back().t);
  if (first == samples.end() || first->t >= end) {
    throw NumericalError(
        "initial state", "",
        fmt::format("IMU ({} to {}) and GNSS ({} to {}) do not overlap in time. Check gps_week and time offsets.",
                    to_string(samples.front().t), to_string(samples.back().t), to_string(fixes.front().t),
                    to_string(fixes.back().t)));
  }
  return {static_cast<std::size_t>(first - samples.begin()), first->t, end};
}

struct Means {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  double rate_sd = 0.0;  // of the mean, from the scatter of means over seconds
  double length = 0.0;   // s
};

Means mean_over(const record::ImuRecording& imu, std::size_t first, std::size_t last) {
  Means means;
  std::vector<Eigen::Vector3d> seconds;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double sum_length = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const record::ImuSample& sample = imu.samples[i];
    means.force += sample.dv;
    means.rate += sample.dtheta;
    means.length += sample.dt;
    sum += sample.dtheta;
    sum_length += sample.dt;
    if (sum_length < 1.0) continue;
    seconds.emplace_back(sum / sum_length);
    sum.setZero();
    sum_length = 0.0;
  }
  means.force /= means.length;
  means.rate /= means.length;
  double squares = 0.0;
  for (const Eigen::Vector3d& second : seconds) squares += (second - means.rate).squaredNorm() / 3.0;
  const auto n = static_cast<double>(seconds.size());
  if (seconds.size() > 1) means.rate_sd = std::sqrt(squares / ((n - 1.0) * n));
  return means;
}

// Roll and pitch of a body at rest; yaw zero.
Eigen::Matrix3d levelled(const Eigen::Vector3d& f_b) {
  return geo::dcm_from_euler({std::atan2(-f_b.y(), -f_b.z()), std::atan2(f_b.x(), std::hypot(f_b.y(), f_b.z())), 0.0});
}

// The yaw that brings a levelled attitude closest to another: without Euler angles of the body, for any mounting.
double yaw_towards(const Eigen::Matrix3d& C_level, const Eigen::Matrix3d& C_b_n) {
  const Eigen::Matrix3d M = C_level * C_b_n.transpose();
  return std::atan2(M(0, 1) - M(1, 0), M(0, 0) + M(1, 1));
}

Eigen::Matrix3d about_down(double yaw) {
  return geo::dcm_from_euler({0.0, 0.0, yaw});
}

double accel_bias_sd(const AlignmentInput& input) {
  return std::max(input.accel_bias_sd, kMinForceBias);
}

// Attitude relative to e, propagated by the gyro from the start of sample `from` back to the start of sample `to` <= from.
Eigen::Matrix3d carried_back(const AlignmentInput& input, const Eigen::Matrix3d& C_b_e, std::size_t from, std::size_t to,
                             const Eigen::Vector3d& gyro_bias) {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  // b at `from` to b at `to`
  RawIncrement previous;
  double seconds = 0.0;
  for (std::size_t i = to; i < from; ++i) {
    const record::ImuSample& sample = input.imu.samples[i];
    const RawIncrement raw{sample.dt, sample.dtheta - sample.dt * gyro_bias, sample.dv};
    turn = (turn * geo::quaternion_from_rotation_vector(compensate_two_sample(previous, raw).phi)).normalized();
    previous = raw;
    seconds += sample.dt;
  }
  return Eigen::AngleAxisd(geo::kEarthRate * seconds, Eigen::Vector3d::UnitZ()).toRotationMatrix() * C_b_e *
         turn.conjugate().toRotationMatrix();
}

// A heading found from motion, with all related results.
struct Heading {
  std::size_t first = 0;  // of the window
  Eigen::Matrix3d C_b_n;  // propagated to the requested instant
  Eigen::Vector3d sd_n;   // rad, about N, E, D
  Eigen::Vector3d gyro_bias;
  Eigen::Vector3d accel_bias;
  double force_error = 0.0;  // m/s^2
  double window_s = 0.0;
};

std::size_t sample_after(const record::ImuRecording& imu, geo::GpsTime t) {
  const auto at = std::upper_bound(imu.samples.begin(), imu.samples.end(), t,
                                   [](geo::GpsTime time, const record::ImuSample& sample) { return time < sample.t; });
  return static_cast<std::size_t>(at - imu.samples.begin());
}

// Time without measurements in samples [first, end), s.
double missing_seconds(const record::ImuRecording& imu, std::size_t first, std::size_t end) {
  double missing = 0.0;
  for (std::size_t i = first; i < end; ++i)
    if (imu.samples[i].dt > 1.5 / imu.rate_hz + kShortGap) missing += imu.samples[i].dt;
  return missing;
}

// Heading at the start of sample `at` from the first sufficient stretch of motion after it, or from the best one.
std::optional<Heading> heading_from_motion(const AlignmentInput& input, const Span& span, std::size_t at,
                                           const Eigen::Vector3d& gyro_bias, double gyro_bias_sd, bool vehicle_forward) {
  const auto& samples = input.imu.samples;
  const geo::GpsTime t_at = samples[at].t - samples[at].dt;
  const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(input.gnss.fixes.front().r_ea_e)).transpose();
  const double longest = std::max(kLongestWindow, kIntervals * typical_interval(input.gnss));
  std::optional<Heading> best;
  for (double from = 0.0; from < kSearch && t_at + from < span.end; from += kSearchStep) {
    Eigen::Vector3d nearby = gyro_bias;  // a short window tolerates a poor bias; its estimate is the start for longer ones
    for (double length = kShortestWindow; length <= longest; length *= 2.0) {
      const std::size_t first = sample_after(input.imu, t_at + from + 1e-6);
      const std::size_t end = sample_after(input.imu, std::min(span.end, t_at + from + length));
      if (end <= first + 1 || samples[end - 1].t - samples[first].t < 0.5 * length) break;
      if (missing_seconds(input.imu, first, end) > 0.0) break;
      const auto match = match_specific_force({input.imu, input.gnss, first, end - 1, input.lever_arm_b, gyro_bias,
                                               gyro_bias_sd, nearby, accel_bias_sd(input), vehicle_forward});
      if (!match) continue;
      nearby = match->gyro_bias;
      if (match->lead < kClearLead) continue;
      Heading heading;
      heading.first = first;
      heading.window_s = samples[end - 1].t - samples[first].t;
      heading.C_b_n = C_e_n * carried_back(input, match->C_b_e, first, at, match->gyro_bias);
      const double carried_s = samples[first].t - samples[at].t;
      const double carried = std::pow(match->gyro_bias_sd * carried_s, 2) + std::pow(input.gyro_noise_density, 2) * carried_s +
                             std::pow(kGapRateSd * missing_seconds(input.imu, at, first), 2);
      heading.sd_n = ((C_e_n * match->psi_covariance_e * C_e_n.transpose()).diagonal().array() + carried).sqrt();
      heading.gyro_bias = match->gyro_bias;
      heading.accel_bias = match->accel_bias;
      heading.force_error =
          std::sqrt(kForceError * kForceError + match->residual_sd * match->residual_sd +
                    std::pow(geo::kStandardGravity, 2) * carried + std::pow(match->horizontal_force * heading.sd_n.z(), 2));
      if (!best || heading.sd_n.z() < best->sd_n.z()) best = heading;
      if (best->sd_n.z() < kGoodHeading) return best;
    }
    if (best && best->sd_n.z() < kFairHeading && from >= kPatience) break;
  }
  return best;
}

void require_usable(const std::optional<Heading>& heading, const Span& span, bool vehicle_forward) {
  if (heading && heading->sd_n.z() < kUsableHeading) return;
  const std::string found =
      heading ? fmt::format("the best stretch gives {:.0f} deg", heading->sd_n.z() / geo::kDegree) : "no stretch gives one";
  const std::string hint = vehicle_forward ? "" : "For a vehicle whose x axis points forward, state `vehicle:`. ";
  throw NumericalError(
      "initial heading", to_string(span.t),
      fmt::format("the first {:.0f} s of motion must show the heading within {:.0f} deg, {}: too little "
                  "horizontal acceleration for this GNSS. {}{}",
                  std::min(kSearch, span.end - span.t), kUsableHeading / geo::kDegree, found, hint, kGiveStart));
}

// Position at standstill: the mean of the fixes during it, whose errors are correlated. Without fixes, that of the first fix
// after it, with an uncertainty for the displacement until then, at the speed of the following fixes.
TrackPoint standing_antenna(const AlignmentInput& input, const Span& span, const StaticPeriod& period) {
  constexpr double kLeastSpeed = 2.0;  // m/s
  TrackPoint antenna{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0, kStandstillVelocitySd};
  const std::vector<record::GnssFix>& fixes = input.gnss.fixes;
  const geo::GpsTime end = input.imu.samples[period.last].t;
  double count = 0.0;
  for (const record::GnssFix& fix : fixes) {
    if (fix.t < span.t || fix.t > end) continue;
    count += 1.0;
    antenna.r_ea_e += (fix.r_ea_e - antenna.r_ea_e) / count;
    antenna.sd_position += (axis_sd(fix.position_cov_n) - antenna.sd_position) / count;
  }
  const auto behind = std::ranges::upper_bound(fixes, end, {}, &record::GnssFix::t);
  if (count > 0.0 || fixes.end() - behind < 2) return count > 0.0 ? antenna : track_point(input.gnss, span.t);
  const record::GnssFix &first = *behind, &second = *(behind + 1);
  const double speed = std::max(kLeastSpeed, (second.r_ea_e - first.r_ea_e).norm() / (second.t - first.t));
  antenna.r_ea_e = first.r_ea_e;
  antenna.sd_position = axis_sd(first.position_cov_n) + speed * (first.t - end);
  return antenna;
}

InitialState from_standstill(const AlignmentInput& input, const Span& span, const StaticPeriod& period, bool vehicle_forward) {
  const auto& samples = input.imu.samples;
  const Means means = mean_over(input.imu, period.first, period.last);
  const Eigen::Matrix3d C_level = levelled(means.force);
  const TrackPoint antenna = standing_antenna(input, span, period);
  const geo::Geodetic p = geo::geodetic_from_ecef(antenna.r_ea_e);
  const Eigen::Matrix3d C_n_e = geo::C_n_e(p);
  const Eigen::Vector3d omega_ie_n = C_n_e.transpose() * Eigen::Vector3d(0.0, 0.0, geo::kEarthRate);
  const double horizontal = std::abs(omega_ie_n.x());

  InitialState state;
  state.nav.t = span.t;
  const double tilt_sd = accel_bias_sd(input) / means.force.norm();
  const double rate_sd = std::hypot(means.rate_sd, input.gyro_noise_density / std::sqrt(means.length));
  const double compass_sd = std::hypot(input.gyro_bias_sd, rate_sd) / std::max(horizontal, 1e-12);
  double yaw = 0.0, yaw_sd = 0.0;
  std::string heading_text;
  if (input.gyro_bias_sd > 0.0 && compass_sd < kGyrocompass) {
    const Eigen::Vector3d rate_level = C_level * means.rate;  // north component at -yaw from the levelled x axis
    yaw = std::atan2(-rate_level.y(), rate_level.x());
    yaw_sd = std::hypot(compass_sd, tilt_sd * std::tan(p.latitude));
    heading_text = "heading by gyrocompassing";
  } else {
    // Earth's rate is part of the mean at rest; its horizontal part, of unknown direction in the body, is not subtracted yet.
    const Eigen::Vector3d bias = means.rate - C_level.transpose() * Eigen::Vector3d(0.0, 0.0, omega_ie_n.z());
    const double bias_sd = std::hypot(rate_sd, horizontal) + kLeastBiasSd;
    const auto heading = heading_from_motion(input, span, period.last, bias, bias_sd, vehicle_forward);
    require_usable(heading, span, vehicle_forward);
    yaw = yaw_towards(C_level, heading->C_b_n);
    yaw_sd = heading->sd_n.z();
    heading_text = fmt::format("heading from GNSS and specific force in {:.0f} s of motion from {:.1f} s after the start",
                               heading->window_s, samples[heading->first].t - span.t);
  }
  const Eigen::Matrix3d C_b_n = about_down(yaw) * C_level;
  state.sd_attitude_n = {tilt_sd, tilt_sd, yaw_sd};
  state.gyro_bias = means.rate - C_b_n.transpose() * omega_ie_n;
  state.gyro_bias_sd = std::hypot(rate_sd, horizontal * std::min(yaw_sd, 1.0)) + kLeastBiasSd;
  const Eigen::Matrix3d C_b_e = C_n_e * C_b_n;
  state.nav.q_b_e = Eigen::Quaterniond(C_b_e).normalized();
  state.nav.r_eb_e = antenna.r_ea_e - C_b_e * input.lever_arm_b;
  state.sd_position_n.setConstant(std::hypot(antenna.sd_position, yaw_sd * input.lever_arm_b.norm()));
  state.sd_velocity_n.setConstant(kStandstillVelocitySd);
  state.method =
      fmt::format("levelled over {:.1f} s standing still, {} ({:.2f} deg)", means.length, heading_text, yaw_sd / geo::kDegree);
  return state;
}

InitialState from_motion(const AlignmentInput& input, const Span& span, bool vehicle_forward) {
  const double bias_sd = input.gyro_bias_sd > 0.0 ? input.gyro_bias_sd : 0.02;  // rad/s; an uncalibrated MEMS
  const auto& samples = input.imu.samples;
  const std::size_t at = std::min(span.first + 1, samples.size() - 1);  // its interval starts at the mission's first epoch
  const auto heading = heading_from_motion(input, span, at, Eigen::Vector3d::Zero(), bias_sd, vehicle_forward);
  require_usable(heading, span, vehicle_forward);

  InitialState state;
  state.nav.t = span.t;
  state.sd_attitude_n = heading->sd_n;
  state.gyro_bias = heading->gyro_bias;
  const Eigen::Matrix3d C_b_e = geo::C_n_e(geo::geodetic_from_ecef(input.gnss.fixes.front().r_ea_e)) * heading->C_b_n;
  const TrackPoint body = start_point(input, {at, C_b_e, heading->gyro_bias, heading->accel_bias, heading->force_error});
  state.nav.q_b_e = Eigen::Quaterniond(C_b_e).normalized();
  state.nav.r_eb_e = body.r_ea_e;
  state.nav.v_eb_e = body.v_ea_e;
  state.sd_position_n.setConstant(std::hypot(body.sd_position, heading->sd_n.maxCoeff() * input.lever_arm_b.norm()));
  state.sd_velocity_n.setConstant(body.sd_velocity);
  state.method = fmt::format(
      "attitude from GNSS and specific force in {:.0f} s of motion from {:.1f} s after the start ({:.2f} deg heading)",
      heading->window_s, samples[heading->first].t - span.t, heading->sd_n.z() / geo::kDegree);
  return state;
}

}  // namespace

InitialState align(const AlignmentInput& input, bool vehicle_forward) {
  const Span span = common_span(input);
  for (const StaticPeriod& period : find_static_periods(input.imu, &input.gnss)) {
    const auto& samples = input.imu.samples;
    const bool at_start = samples[period.first].t <= span.t + 1.0 && samples[period.last].t >= span.t + 1.0;
    if (at_start) return from_standstill(input, span, period, vehicle_forward);
  }
  return from_motion(input, span, vehicle_forward);
}

}  // namespace coast::ins
