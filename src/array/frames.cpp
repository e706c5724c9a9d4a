#include "coast/array/frames.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coast/geo/rotation.hpp"
#include "residuals.hpp"

namespace coast::array {

namespace {

constexpr int kDegreeOfFit = 4;
constexpr int kNarrowest = 2;  // of the differentiators: five samples determine a polynomial of fourth degree

/// Mean rates over the sensors that may be used; over all if none may.
Eigen::Matrix3Xd mean_rates(const Signals& signals) {
  const auto count = static_cast<Eigen::Index>(signals.samples());
  Eigen::Matrix3Xd omega(3, count);
  for (Eigen::Index n = 0; n < count; ++n)
    for (int c = 0; c < 3; ++c) omega(c, n) = plain_mean(signals, c, static_cast<std::size_t>(n));
  return omega;
}

/// Noise of the mean rates from the sensors' differences of adjacent samples: constant biases and common motion cancel.
double noise_of_mean(const Signals& signals) {
  double sum = 0.0;
  double terms = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (std::size_t n = 1; n < signals.samples(); ++n) {
      const SpreadOfChange spread = spread_of_change(signals, c, n);
      if (spread.sensors < 2) continue;
      // Each sensor's change has twice the variance of a sample; the mean of K has 1/K of it.
      sum += spread.variance / 2.0 / static_cast<double>(spread.sensors);
      terms += 1.0;
    }
  }
  return terms > 0.0 ? std::sqrt(sum / terms) : 0.0;
}

/// Mean square of the difference of two derivatives, per axis.
double mean_square(const Eigen::Matrix3Xd& difference) {
  return difference.squaredNorm() / static_cast<double>(difference.size());
}

/// Half widths to be tried: each about 1.4 times the one before.
constexpr std::array kHalfWidths{2, 3, 4, 6, 8, 11, 16, 22, 31, 44};

/// A derivative and the next narrower one.
struct Candidate {
  Eigen::Matrix3Xd alpha;
  Eigen::RowVectorXd coefficients;
  int half_width = 0;
};

/// Sum of squares of the difference of two filters: its noise for white noise of variance 1.
double noise_of_difference(const Eigen::RowVectorXd& wide, const Eigen::RowVectorXd& narrow) {
  Eigen::RowVectorXd difference = wide;
  difference.segment((wide.size() - narrow.size()) / 2, narrow.size()) -= narrow;
  return difference.squaredNorm();
}

/// Mean square of the motion lost by the wider of two derivatives. Their difference contains the noise of both, which is known,
/// and of the lost motion, which grows with the fourth power of the width, the part that the narrower one has not lost too.
double lost_motion(const Candidate& wide, const Candidate& narrow, double variance) {
  // Within m samples of an end a slope is noisier than the filter in the middle: left out if there is a middle.
  const Eigen::Index edge = wide.alpha.cols() > 8 * wide.half_width ? wide.half_width : 0;
  const Eigen::Index inner = wide.alpha.cols() - 2 * edge;
  const double moved = mean_square(wide.alpha.middleCols(edge, inner) - narrow.alpha.middleCols(edge, inner));
  const double share = 1.0 - std::pow(static_cast<double>(narrow.half_width) / wide.half_width, 4);
  return std::max(0.0, moved - variance * noise_of_difference(wide.coefficients, narrow.coefficients)) / (share * share);
}

}  // namespace

Differentiator::Differentiator(int half_width, double dt) : half_width_(half_width), dt_(dt) {
  if (half_width < kNarrowest || !(dt > 0.0))
    throw std::invalid_argument(
        fmt::format("Differentiator: half_width {} below {}, or dt {} not above zero", half_width, kNarrowest, dt));
  const int width = 2 * half_width + 1;
  // Abscissae in units of the half width keep the powers of the fit near 1.
  Eigen::MatrixXd powers(width, kDegreeOfFit + 1);
  for (int i = 0; i < width; ++i)
    for (int k = 0; k <= kDegreeOfFit; ++k) powers(i, k) = std::pow(static_cast<double>(i - half_width) / half_width, k);
  const Eigen::MatrixXd fit = powers.householderQr().solve(Eigen::MatrixXd::Identity(width, width)).topRows(kDegreeOfFit + 1);
  slope_at_.resize(width, width);
  for (int i = 0; i < width; ++i) {
    Eigen::RowVectorXd slope = Eigen::RowVectorXd::Zero(kDegreeOfFit + 1);
    for (int k = 1; k <= kDegreeOfFit; ++k)
      slope(k) = k * std::pow(static_cast<double>(i - half_width) / half_width, k - 1) / (half_width * dt);
    slope_at_.row(i) = slope * fit;
  }
}

double Differentiator::noise_gain() const {
  return slope_at_.row(half_width_).norm();
}

double Differentiator::response(double frequency) const {
  const double phase = 2.0 * std::numbers::pi * frequency * dt_;
  if (phase == 0.0) return 1.0;
  double imaginary = 0.0;
  for (int j = -half_width_; j <= half_width_; ++j) imaginary += slope_at_(half_width_, j + half_width_) * std::sin(phase * j);
  return imaginary * dt_ / phase;
}

Eigen::Matrix3Xd Differentiator::apply(const Eigen::Ref<const Eigen::Matrix3Xd>& x) const {
  const Eigen::Index width = 2 * half_width_ + 1;
  if (x.cols() < width)
    throw std::invalid_argument(fmt::format("Differentiator::apply: {} samples, at least {} needed", x.cols(), width));
  Eigen::Matrix3Xd slope(3, x.cols());
  for (Eigen::Index n = 0; n < x.cols(); ++n) {
    const Eigen::Index first = std::clamp<Eigen::Index>(n - half_width_, 0, x.cols() - width);
    slope.col(n).noalias() = x.middleCols(first, width) * slope_at_.row(n - first).transpose();
  }
  return slope;
}

AngularMotion angular_motion(const Signals& signals) {
  if (signals.sensors.empty()) throw std::invalid_argument("angular_motion: no sensors");
  AngularMotion motion;
  motion.omega = mean_rates(signals);
  motion.noise_sd = noise_of_mean(signals);
  const double variance = motion.noise_sd * motion.noise_sd;
  Candidate before;
  double lost = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const int m : kHalfWidths) {
    if (2 * m + 1 > motion.omega.cols()) break;
    const Differentiator d(m, signals.dt);
    Candidate candidate{d.apply(motion.omega), d.coefficients(), m};
    // Two derivatives that are both too wide differ little: what a narrower one loses is lost in a wider one as well.
    if (before.half_width > 0) lost = std::max(lost, lost_motion(candidate, before, variance));
    const double risk = lost + variance * candidate.coefficients.squaredNorm();
    if (risk < least) {
      least = risk;
      motion.half_width = m;
      motion.alpha = candidate.alpha;
    }
    before = std::move(candidate);
  }
  if (motion.half_width == 0) throw std::invalid_argument("angular_motion: fewer than 5 samples");
  motion.error_sd = std::sqrt(least);
  return motion;
}

void turn_to_body(Signals& signals, const std::vector<SensorFrame>& frames) {
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
    auto& values = signals.sensors[k].values;
    const Eigen::Matrix3d& C_s_b = frames.at(k).C_s_b;
    values.topRows<3>() = (C_s_b * values.topRows<3>()).eval();
    values.bottomRows<3>() = (C_s_b * values.bottomRows<3>()).eval();
  }
}

Eigen::Vector3d size_effect(const Eigen::Vector3d& omega, const Eigen::Vector3d& alpha, const Eigen::Vector3d& r_b, double dt) {
  return alpha.cross(r_b) + omega.cross(omega.cross(r_b)) + dt * dt / 12.0 * alpha.cross(alpha.cross(r_b));
}

void move_to_origin(Signals& signals, const std::vector<SensorFrame>& frames, const AngularMotion& motion) {
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
    const Eigen::Vector3d& r_b = frames.at(k).r_b;
    if (r_b.isZero(0.0)) continue;
    auto forces = signals.sensors[k].values.bottomRows<3>();
    for (Eigen::Index n = 0; n < forces.cols(); ++n)
      forces.col(n) -= size_effect(motion.omega.col(n), motion.alpha.col(n), r_b, signals.dt);
  }
}

}  // namespace coast::array
