#include "start_point.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "coast/geo/units.hpp"
#include "coast/ins/strapdown.hpp"

namespace coast::ins {
namespace {

constexpr double kShortest = 1.0, kLongest = 12.0;  // s; longer if the second fix is later
constexpr std::size_t kFixes = 3;                   // at least, if they are within kLongest
constexpr double kVelocitySpan = 0.02;              // s, to both sides

// The antenna's path by strapdown from an initial guess.
struct PredictedPath {
  std::vector<double> t;  // s since the start
  std::vector<Eigen::Vector3d> r_e;

  [[nodiscard]] Eigen::Vector3d at(double time) const {
    const auto behind = std::upper_bound(t.begin() + 1, t.end() - 1, time);
    const auto i = static_cast<std::size_t>(behind - t.begin());
    return r_e[i - 1] + (time - t[i - 1]) / (t[i] - t[i - 1]) * (r_e[i] - r_e[i - 1]);
  }
  [[nodiscard]] Eigen::Vector3d velocity(double time) const {
    const double from = std::max(time - kVelocitySpan, t.front()), to = std::min(time + kVelocitySpan, t.back());
    return (at(to) - at(from)) / (to - from);
  }
};

PredictedPath predict(const AlignmentInput& input, const StartAttitude& attitude, const record::NavState& guess,
                      geo::GpsTime end) {
  PredictedPath path{{0.0}, {guess.r_eb_e + attitude.C_b_e * input.lever_arm_b}};
  Strapdown strapdown(guess);
  RawIncrement previous;
  for (std::size_t i = attitude.at; i < input.imu.samples.size(); ++i) {
    const record::ImuSample& sample = input.imu.samples[i];
    if (sample.t - sample.dt >= end) break;
    const RawIncrement raw{sample.dt, sample.dtheta - sample.dt * attitude.gyro_bias,
                           sample.dv - sample.dt * attitude.accel_bias};
    strapdown.step(compensate_two_sample(previous, raw));
    previous = raw;
    path.t.push_back(sample.t - guess.t);
    path.r_e.emplace_back(strapdown.state().r_eb_e + strapdown.C_b_e() * input.lever_arm_b);
  }
  return path;
}

// Two fixes determine a velocity.
geo::GpsTime second_fix(const record::GnssRecording& gnss, geo::GpsTime start) {
  const auto first = std::ranges::lower_bound(gnss.fixes, start, {}, &record::GnssFix::t);
  return gnss.fixes.end() - first < 2 ? start : (first + 1)->t;
}

// Residual = offset + slope t per axis, equal weights for all axes.
struct Line {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 2, 3> right = Eigen::Matrix<double, 2, 3>::Zero();
  void add(const Eigen::Vector2d& design, const Eigen::Vector3d& residual, double variance) {
    normal += design * design.transpose() / variance;
    right += design * residual.transpose() / variance;
  }
};

}  // namespace

TrackPoint start_point(const AlignmentInput& input, const StartAttitude& attitude) {
  const record::ImuSample& first = input.imu.samples[attitude.at];
  const geo::GpsTime start = first.t - first.dt;
  const TrackPoint rough = track_point(input.gnss, start);
  record::NavState guess{start, rough.r_ea_e - attitude.C_b_e * input.lever_arm_b, rough.v_ea_e,
                         Eigen::Quaterniond(attitude.C_b_e)};
  const PredictedPath path = predict(input, attitude, guess, std::max(start + kLongest, second_fix(input.gnss, start)));

  const record::GnssFix& near = input.gnss.fixes.front();
  const double sd = axis_sd(near.position_cov_n);
  // With its length the slope of the fixes improves (sqrt(2) sd / T), and the subtracted motion degrades (force error T/2).
  const double horizon = std::clamp(std::sqrt(std::sqrt(8.0) * sd / attitude.force_error), kShortest, kLongest);

  Line line;
  std::size_t used = 0;
  double last = 0.0;
  for (const record::GnssFix& fix : input.gnss.fixes) {
    const double t = fix.t - start;
    if (t < 0.0) continue;
    if (t > path.t.back() || (t > horizon && used >= kFixes)) break;
    const double velocity_error = attitude.force_error * t;
    line.add({1.0, t}, fix.r_ea_e - path.at(t),
             std::pow(axis_sd(fix.position_cov_n), 2) + std::pow(0.5 * velocity_error * t, 2));
    if (fix.velocity)
      line.add({0.0, 1.0}, velocity_e(fix) - path.velocity(t),
               std::pow(axis_sd(fix.velocity->cov_n), 2) + std::pow(velocity_error, 2));
    ++used;
    last = t;
  }
  if (used < 2) return {guess.r_eb_e, guess.v_eb_e, rough.sd_position, rough.sd_velocity};
  const Eigen::Matrix2d cofactor = line.normal.inverse();
  const Eigen::Matrix<double, 2, 3> fitted = cofactor * line.right;
  // Errors of adjacent fixes are correlated: their number does not reduce the sigma of a position, and hardly that of the
  // slope.
  const double slope_sd = near.velocity ? axis_sd(near.velocity->cov_n) : std::sqrt(2.0) * sd / last;
  const double sd_velocity = std::hypot(std::max(slope_sd, std::sqrt(cofactor(1, 1))), 0.5 * attitude.force_error * last);
  return {guess.r_eb_e + fitted.row(0).transpose(), guess.v_eb_e + fitted.row(1).transpose(),
          std::max(sd, std::sqrt(cofactor(0, 0))), sd_velocity};
}

}  // namespace coast::ins
