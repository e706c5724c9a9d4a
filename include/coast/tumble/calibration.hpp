#pragma once
// Multi-position calibration: constant errors of gyros and accelerometers from rests in many poses and the turns between them.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coast/record/imu.hpp"
#include "coast/record/imu_calibration.hpp"
#include "coast/tumble/rests.hpp"

namespace coast::tumble {

struct Options {
  double gravity = 9.80665;        ///< m/s^2, at the place of the recording
  double gravity_sd = 0.015;       ///< m/s^2; the default is that of an unknown place on Earth
  std::optional<double> latitude;  ///< rad; without it the Earth's rate is part of the gyros' bias
  double longest_turn = 60.0;      ///< s; after a longer one only the specific forces are compared
};

/// What remains of one rest.
struct RestFit {
  Rest rest;
  Eigen::Vector3d up;              ///< direction of the specific force, calibrated axes, unit vector
  Eigen::Vector3d accel_residual;  ///< observed minus predicted mean, m/s^2, sensor axes
  Eigen::Vector3d gyro_bias;       ///< estimated at this rest, rad/s
  double chi_square = 0.0;         ///< of the accelerometers' residual, three degrees of freedom
  bool used = true;                ///< false: contradicts all others
};

/// What remains of the turn that follows a rest.
struct TurnFit {
  std::size_t rest = 0;      ///< the rest before it
  double duration = 0.0;     ///< s
  double turned = 0.0;       ///< integral of |rate|, rad
  Eigen::Vector3d residual;  ///< rotation from the gyros minus that from the poses, rotation vector, rad, axes before it
  double chi_square = 0.0;   ///< three degrees of freedom
  bool used = true;
};

/// Levels of what the recording itself does not explain, estimated with the errors (restricted maximum likelihood).
struct Levels {
  double accel = 0.0;      ///< m/s^2, of the mean of one rest: bias that wanders, table that gives way
  double turn = 0.0;       ///< rad per rad turned: timing, nonlinearity, bandwidth of the gyros
  double gyro_walk = 0.0;  ///< rad/s/sqrt(s), of the gyros' biases from rest to rest
};

struct Result {
  record::ImuCalibration calibration;
  double gravity = 0.0;  ///< m/s^2, adjusted
  double gravity_sd = 0.0;
  std::vector<RestFit> rests;
  std::vector<TurnFit> turns;
  Levels levels;
  double redundancy = 0.0;           ///< observations minus what they determine
  std::optional<double> heading_sd;  ///< rad, of all poses together, where the Earth's rate was used
  /// Covariance of the accelerometers' bias x, y, z and gain xx, yy, zz, xy, xz, yz, gravity known.
  Eigen::Matrix<double, 9, 9> accel_covariance;
};

/// Weighted least squares over all rests and turns at once. Unknowns: bias and symmetric gain of the accelerometers, gain of
/// the gyros (nine values), gravity within its sd, and for every rest the attitude and the gyros' bias. Observations: mean
/// specific force and rate of each rest, the rotation integrated from the gyros between two rests, and biases that change
/// little from rest to rest. The axes are those in which the accelerometers' gain is symmetric: the orthogonal axes nearest to
/// the three sensitive axes. Gauss-Newton; levels by restricted maximum likelihood; observations whose chi-square of three
/// exceeds 25 are left out one by one.
/// @throws InputError  too few poses, or turns that the gyros contradict: wrong axes, signs or units
/// @see  Tedaldi, Pretto, Menegatti (2014), A robust and easy to implement method for IMU calibration without external
///       equipments, ICRA, for the experiment; there two steps, magnitudes of rests first, and no covariance.
[[nodiscard]] Result calibrate(const record::ImuRecording& sensor, const Options& options,
                               const std::function<void(double)>& progress = {});

}  // namespace coast::tumble
