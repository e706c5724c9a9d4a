#pragma once
// Error-free measurements of an IMU on a moving body: increments of rate and specific force.

#include <Eigen/Core>
#include <optional>

#include "coast/geo/time.hpp"
#include "coast/record/imu.hpp"
#include "coast/simulate/trajectory.hpp"

namespace coast::simulate {

/// Position and axes of the IMU on the body.
struct ImuInstallation {
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< from the body's point to the IMU, m
  Eigen::Matrix3d C_b_s = Eigen::Matrix3d::Identity();    ///< body to sensor axes
};

/// Epochs start + k / rate, rounded to 1 ns; sample k covers the interval between epochs k - 1 and k.
struct ImuSampling {
  geo::GpsTime start;        ///< time of t = 0 of the motion
  double rate_hz = 100.0;    ///< [0.1, 1e5]
  std::optional<int> nodes;  ///< Gauss-Legendre nodes per panel, [1, 12]; if absent 5, or 4 on panels up to 5 ms
};

/// Error-free increments over the whole motion, in sensor axes.
///
///     dtheta = integral of omega_is_s,   dv = integral of f_is_s   over (t - dt, t]
///
/// Composite Gauss-Legendre on panels of at most 10 ms. With the default nodes the error of an increment is below 1e-13 rad and
/// 5e-13 m/s in every motion of the table.
/// @param threads  at least 1; the result is bitwise the same for any number
/// @throws std::invalid_argument  rate, nodes or threads outside their range
[[nodiscard]] record::ImuRecording true_increments(const AnalyticTrajectory& motion, const ImuSampling& sampling,
                                                   const ImuInstallation& installation = {}, int threads = 1);

/// The true states at the start of the motion and at the end of every sample of `recording`.
[[nodiscard]] record::Trajectory true_states(const AnalyticTrajectory& motion, const record::ImuRecording& recording,
                                             geo::GpsTime start, int threads = 1);

}  // namespace coast::simulate
