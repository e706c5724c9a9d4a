#include "coast/array/mounting.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "coast/geo/rotation.hpp"

namespace coast::array {

namespace {

constexpr int kSharpest = 2;   // half width of a differentiator
constexpr int kUnknowns = 12;  // rotation, place, gyro bias, accelerometer bias
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Design = Eigen::Matrix<double, 3, kUnknowns>;

/// Means over blocks in which every sensor may be used throughout.
struct Blocks {
  Eigen::Matrix3Xd omega, alpha, force;                                   // of the platform at the origin
  std::vector<Eigen::Matrix3d> lever;                                     // [alpha x] + [omega x][omega x]
  std::vector<Eigen::Matrix<double, kChannels, Eigen::Dynamic>> sensors;  // in body axes, moved to the origin
  double alpha_noise = 0.0;                                               // rad/s^2, of a block's mean, each axis
};

/// Noise of the mean angular acceleration of a block: white noise of the rates through the differentiator and the mean.
double noise_of_alpha(const AngularMotion& motion, double dt, std::size_t length) {
  const Eigen::RowVectorXd slope = Differentiator(motion.half_width, dt).coefficients();
  Eigen::RowVectorXd both = Eigen::RowVectorXd::Zero(slope.size() + static_cast<Eigen::Index>(length) - 1);
  for (std::size_t i = 0; i < length; ++i) both.segment(static_cast<Eigen::Index>(i), slope.size()) += slope;
  return motion.noise_sd * both.norm() / static_cast<double>(length);
}

bool whole(const Signals& signals, std::size_t first, std::size_t count) {
  for (const SensorSignals& sensor : signals.sensors)
    for (std::size_t n = first; n < first + count; ++n)
      if (sensor.usable[n] != kAllUsable) return false;
  return true;
}

Blocks block_means(const Signals& signals, const AngularMotion& motion, std::size_t length) {
  std::vector<std::size_t> firsts;
  for (std::size_t first = 0; first + length <= signals.samples(); first += length)
    if (whole(signals, first, length)) firsts.push_back(first);
  const auto count = static_cast<Eigen::Index>(firsts.size());
  const auto width = static_cast<Eigen::Index>(length);
  Blocks blocks{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd::Zero(3, count), {}, {}, 0.0};
  blocks.alpha_noise = noise_of_alpha(motion, signals.dt, length);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto first = static_cast<Eigen::Index>(firsts[static_cast<std::size_t>(i)]);
    blocks.omega.col(i) = motion.omega.middleCols(first, width).rowwise().mean();
    blocks.alpha.col(i) = motion.alpha.middleCols(first, width).rowwise().mean();
    // The mean of [omega x]^2 = omega omega' - omega'omega I, not the square of the mean: rates change within a block.
    const Eigen::Matrix3d moments = motion.omega.middleCols(first, width) * motion.omega.middleCols(first, width).transpose();
    blocks.lever.emplace_back(geo::skew(blocks.alpha.col(i)) +
                              (moments - moments.trace() * Eigen::Matrix3d::Identity()) / static_cast<double>(length));
  }
  for (const SensorSignals& sensor : signals.sensors) {
    auto& own = blocks.sensors.emplace_back(kChannels, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto first = static_cast<Eigen::Index>(firsts[static_cast<std::size_t>(i)]);
      own.col(i) = sensor.values.middleCols(first, width).rowwise().mean();
    }
    blocks.force += own.bottomRows<3>() / static_cast<double>(signals.sensors.size());
  }
  return blocks;
}

Design rates_design(const Blocks& blocks, Eigen::Index i) {
  Design H = Design::Zero();
  H.leftCols<3>() = geo::skew(blocks.omega.col(i));
  H.middleCols<3>(6).setIdentity();
  return H;
}

Design forces_design(const Blocks& blocks, Eigen::Index i) {
  Design H = Design::Zero();
  H.leftCols<3>() = geo::skew(blocks.force.col(i));
  H.middleCols<3>(3) = blocks.lever[static_cast<std::size_t>(i)];
  H.rightCols<3>().setIdentity();
  return H;
}

struct Solution {
  Unknowns x = Unknowns::Zero();
  Normal covariance = Normal::Zero();
  double rates_rms = 0.0;   // of the residuals with only the biases subtracted
  double forces_rms = 0.0;  // likewise
  double rates_left = 1.0;  // of the full fit: the weights of the next iteration
  double forces_left = 1.0;
};

/// The angular acceleration is noisy, and its noise e is in the regressors of the position and, by the stated position, in the
/// residuals: least squares would bias the position towards the mean of all. E [e x]'[e x] = 2 sigma^2 I is subtracted on both
/// sides. If the angular acceleration does not exceed its noise, the position is not changed.
void take_off_noise_of_alpha(const Blocks& blocks, double forces_weight, const Eigen::Vector3d& from_mean, Normal& N,
                             Unknowns& b) {
  const double noise = forces_weight * static_cast<double>(blocks.alpha.cols()) * 2.0 * blocks.alpha_noise * blocks.alpha_noise;
  const Eigen::Matrix3d places = N.block<3, 3>(3, 3);
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(places, Eigen::EigenvaluesOnly).eigenvalues()(0);
  if (least < 2.0 * noise) {
    N.middleRows<3>(3).setZero();
    N.middleCols<3>(3).setZero();
    b.segment<3>(3).setZero();
    return;
  }
  N.block<3, 3>(3, 3).diagonal().array() -= noise;
  b.segment<3>(3) += noise * from_mean;
}

/// Residuals of one sensor relative to the mean of all, on its twelve unknowns.
/// @param from_mean  its position minus the mean of all
/// @param refined  sum of corrections to the stated values so far: the prior is centred on the stated values
Solution solve_sensor(const Blocks& blocks, std::size_t k, const Solution& before, const Unknowns& prior_precision,
                      const Unknowns& refined, const Eigen::Vector3d& from_mean) {
  const auto& own = blocks.sensors[k];
  const double rates_weight = 1.0 / (before.rates_left * before.rates_left);
  const double forces_weight = 1.0 / (before.forces_left * before.forces_left);
  Normal N = Normal::Zero();
  Unknowns b = Unknowns::Zero();
  Eigen::Matrix<double, kChannels, Eigen::Dynamic> residuals = own;
  residuals.topRows<3>() -= blocks.omega;
  residuals.bottomRows<3>() -= blocks.force;
  for (Eigen::Index i = 0; i < own.cols(); ++i) {
    const Design rates = rates_design(blocks, i), forces = forces_design(blocks, i);
    N += rates_weight * rates.transpose() * rates + forces_weight * forces.transpose() * forces;
    b += rates_weight * rates.transpose() * residuals.col(i).head<3>() +
         forces_weight * forces.transpose() * residuals.col(i).tail<3>();
  }
  take_off_noise_of_alpha(blocks, forces_weight, from_mean, N, b);
  N.diagonal() += prior_precision;
  b -= prior_precision.cwiseProduct(refined);
  Solution s;
  const Eigen::LLT<Normal> llt(N);
  s.x = llt.solve(b);
  s.covariance = llt.solve(Normal::Identity());
  double rates_left = 0.0, forces_left = 0.0;
  for (Eigen::Index i = 0; i < own.cols(); ++i) {
    rates_left += (residuals.col(i).head<3>() - rates_design(blocks, i) * s.x).squaredNorm();
    forces_left += (residuals.col(i).tail<3>() - forces_design(blocks, i) * s.x).squaredNorm();
  }
  const double values = 3.0 * static_cast<double>(own.cols());
  s.rates_left = std::max(std::sqrt(rates_left / values), 1e-12);
  s.forces_left = std::max(std::sqrt(forces_left / values), 1e-12);
  const Eigen::Matrix<double, kChannels, 1> mean = residuals.rowwise().mean();
  residuals.colwise() -= mean;
  s.rates_rms = std::sqrt(residuals.topRows<3>().squaredNorm() / values);
  s.forces_rms = std::sqrt(residuals.bottomRows<3>().squaredNorm() / values);
  return s;
}

/// A common change of all sensors is no refinement: the mean over the sensors is subtracted.
void hold_datum(std::vector<Solution>& solutions) {
  Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
  for (const Solution& s : solutions) mean += s.x.head<6>() / static_cast<double>(solutions.size());
  for (Solution& s : solutions) s.x.head<6>() -= mean;
}

struct Spread {
  double rates = 0.0;
  double forces = 0.0;
};

Spread rms_over(const std::vector<Solution>& solutions) {
  Spread spread;
  for (const Solution& s : solutions) {
    spread.rates += s.rates_rms * s.rates_rms / static_cast<double>(solutions.size());
    spread.forces += s.forces_rms * s.forces_rms / static_cast<double>(solutions.size());
  }
  return {std::sqrt(spread.rates), std::sqrt(spread.forces)};
}

/// The correction of a stated frame.
Unknowns refinement(const SensorFrame& frame, const SensorFrame& stated) {
  Unknowns x = Unknowns::Zero();
  x.head<3>() = geo::rotation_vector(Eigen::Quaterniond(frame.C_s_b * stated.C_s_b.transpose()));
  x.segment<3>(3) = frame.r_b - stated.r_b;
  return x;
}

std::vector<Solution> solve_all(const Signals& sensor_axes, const std::vector<SensorFrame>& frames,
                                const std::vector<SensorFrame>& stated, double block_s, const std::vector<Solution>& before,
                                const Unknowns& prior_precision) {
  constexpr Eigen::Index kFewestBlocks = 100;
  Signals body = sensor_axes;
  turn_to_body(body, frames);
  AngularMotion motion = angular_motion(body);
  // A wide differentiator loses part of the angular acceleration, which would show as shorter lever arms; means over blocks
  // have low noise.
  motion.half_width = kSharpest;
  motion.alpha = Differentiator(kSharpest, body.dt).apply(motion.omega);
  move_to_origin(body, frames, motion);
  const auto length = static_cast<std::size_t>(std::max(1.0, std::round(block_s / body.dt)));
  const Blocks blocks = block_means(body, motion, length);
  if (blocks.omega.cols() < kFewestBlocks)
    throw std::invalid_argument(
        fmt::format("refine_mounting: {} blocks with all sensors, at least {} needed", blocks.omega.cols(), kFewestBlocks));
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const SensorFrame& frame : frames) middle += frame.r_b / static_cast<double>(frames.size());
  std::vector<Solution> solutions;
  for (std::size_t k = 0; k < frames.size(); ++k)
    solutions.push_back(
        solve_sensor(blocks, k, before[k], prior_precision, refinement(frames[k], stated[k]), frames[k].r_b - middle));
  return solutions;
}

}  // namespace

RefinedMounting refine_mounting(const Signals& sensor_axes, const std::vector<SensorFrame>& stated,
                                const MountingOptions& options) {
  if (stated.size() < 2 || stated.size() != sensor_axes.sensors.size())
    throw std::invalid_argument(
        fmt::format("refine_mounting: {} frames for {} sensors, at least 2", stated.size(), sensor_axes.sensors.size()));
  Unknowns prior_precision = Unknowns::Zero();
  prior_precision.head<3>().setConstant(1.0 / (options.rotation_sd * options.rotation_sd));
  prior_precision.segment<3>(3).setConstant(1.0 / (options.position_sd_m * options.position_sd_m));

  RefinedMounting result;
  std::vector<SensorFrame> frames = stated;
  std::vector<Solution> solutions(stated.size());
  for (Solution& s : solutions) s.rates_left = 0.01, s.forces_left = 0.1;  // initial weights; replaced by the estimates
  for (int pass = 0; pass < options.iterations; ++pass) {
    solutions = solve_all(sensor_axes, frames, stated, options.block_s, solutions, prior_precision);
    if (pass == 0) {
      const Spread spread = rms_over(solutions);
      result.rates_before = spread.rates;
      result.forces_before = spread.forces;
    }
    hold_datum(solutions);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      // The residual omega x phi is removed by the rotation by +phi: v + phi x v = v - v x phi.
      frames[k].C_s_b = geo::rotation_matrix(solutions[k].x.head<3>()) * frames[k].C_s_b;
      frames[k].r_b += solutions[k].x.segment<3>(3);
    }
  }
  const Spread after = rms_over(solve_all(sensor_axes, frames, stated, options.block_s, solutions, prior_precision));
  result.rates_after = after.rates;
  result.forces_after = after.forces;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    RefinedSensor& sensor = result.sensors.emplace_back();
    sensor.frame = frames[k];
    sensor.rotation = refinement(frames[k], stated[k]).head<3>();
    const Eigen::Matrix<double, kUnknowns, 1> sd = solutions[k].covariance.diagonal().cwiseSqrt();
    sensor.rotation_sd = sd.head<3>();
    sensor.position_sd_m = sd.segment<3>(3);
  }
  return result;
}

}  // namespace coast::array
