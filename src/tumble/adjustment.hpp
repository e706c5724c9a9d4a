#pragma once
// The observation equations of rests and turns, linearised, and their normal equations.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "coast/tumble/calibration.hpp"
#include "turn.hpp"

namespace coast::tumble {

/// Unknowns common to all rests, in this order.
struct Common {
  static constexpr int kAccelBias = 0;
  static constexpr int kAccelGain = 3;  ///< xx, yy, zz, xy, xz, yz
  static constexpr int kGravity = 9;
  static constexpr int kGyroGain = 10;  ///< xx, xy, xz, yx, ..., zz
  static constexpr int kCount = 19;

  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  Eigen::Matrix3d accel_gain = Eigen::Matrix3d::Zero();  ///< symmetric
  double gravity = 0.0;
  Eigen::Matrix3d gyro_gain = Eigen::Matrix3d::Zero();
};

/// Row and column of the six values of a symmetric gain.
inline constexpr std::array<std::array<int, 2>, 6> kSymmetric{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

/// Unknowns of one rest: rotation of the attitude about N, E, D, and the gyros' bias.
struct Pose {
  static constexpr int kCount = 6;
  Eigen::Matrix3d C_b_n = Eigen::Matrix3d::Identity();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
};

struct State {
  Common common;
  std::vector<Pose> poses;
};

enum class Kind { kForce, kRate, kTurn, kWalk };
inline constexpr std::size_t kKinds = 4;

/// Three observations: residual = jacobian x unknowns + noise, noise variance = white + level^2 shape.
struct Observation {
  Kind kind = Kind::kForce;
  std::size_t rest = 0;
  bool pair = false;  ///< of this rest and the next one
  bool used = true;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, Common::kCount> common = Eigen::Matrix<double, 3, Common::kCount>::Zero();
  Eigen::Matrix<double, 3, Pose::kCount> own = Eigen::Matrix<double, 3, Pose::kCount>::Zero();
  Eigen::Matrix<double, 3, Pose::kCount> next = Eigen::Matrix<double, 3, Pose::kCount>::Zero();
  Eigen::Vector3d white = Eigen::Vector3d::Zero();
  double shape = 0.0;
};

/// Levels squared, by kind; that of rates stays zero.
using Variances = std::array<double, kKinds>;

/// All observations about a state; turns that are too long, or lack samples, are marked as not used.
/// @param turns  those integrated, one after each rest but the last
[[nodiscard]] std::vector<Observation> linearised(const record::ImuRecording& sensor, const std::vector<Rest>& rests,
                                                  const Options& options, const State& state, std::vector<Turn>& turns);

struct Solution {
  Eigen::VectorXd change;      ///< of the unknowns
  Eigen::MatrixXd covariance;  ///< of all unknowns
};
[[nodiscard]] Solution solve(const std::vector<Observation>& observations, const Options& options, const State& state,
                             const Variances& levels);
void add(State& state, const Eigen::VectorXd& change);

/// Covariance of the predicted observation.
[[nodiscard]] Eigen::Matrix3d predicted(const Observation& observation, const Eigen::MatrixXd& covariance);
[[nodiscard]] Eigen::Vector3d noise(const Observation& observation, const Variances& levels);

}  // namespace coast::tumble
