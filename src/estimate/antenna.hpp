#pragma once
// Common functions of updates at a point off the IMU; private to the room.

#include "coast/estimate/update.hpp"

namespace coast::estimate {

/// The antenna in the filter: configured lever arm and its estimated correction.
struct Antenna {
  Eigen::Vector3d l_ba_b;
  Eigen::Matrix3d C_b_e;
  Eigen::Vector3d l_ba_e;
  Eigen::Vector3d v_ba_e;  ///< velocity relative to the IMU: C (omega x l)
};
[[nodiscard]] Antenna antenna(const FilterState& state, const UpdateContext& context);

/// Predicted position or velocity of the antenna, and its derivative with respect to the errors.
struct AntennaPrediction {
  Eigen::Vector3d value_e;
  Eigen::MatrixXd H;  ///< 3 x n
};
/// Position of the antenna at the time of validity of a fix with the filter's time tag: moved by an estimated time offset.
[[nodiscard]] AntennaPrediction antenna_position(const FilterState& state, const UpdateContext& context);
[[nodiscard]] AntennaPrediction antenna_velocity(const FilterState& state, const UpdateContext& context);

/// H += factor * d(v_ea_e)/d(error), v_ea = v_eb + C (omega x l).
void add_antenna_velocity(const Antenna& antenna, const UpdateContext& context, double factor, Eigen::MatrixXd& H);

/// H += A d(omega_eb_b)/d(error): the rate includes the gyro's estimated errors. A is m x 3.
void add_rate(const Eigen::Matrix3d& A, const UpdateContext& context, Eigen::MatrixXd& H);

}  // namespace coast::estimate
