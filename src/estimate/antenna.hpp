#pragma once
// What updates at a point off the IMU have in common; private to the room.

#include "coast/estimate/update.hpp"

namespace coast::estimate {

/// The antenna as the filter has it: configured lever arm and its estimated correction.
struct Antenna {
  Eigen::Vector3d l_ba_b;
  Eigen::Matrix3d C_b_e;
  Eigen::Vector3d l_ba_e;
  Eigen::Vector3d v_ba_e;  ///< velocity against the IMU: C (omega x l)
};
[[nodiscard]] Antenna antenna(const FilterState& state, const UpdateContext& context);

/// Position or velocity of the antenna as predicted, and its derivative by the errors.
struct AntennaPrediction {
  Eigen::Vector3d value_e;
  Eigen::MatrixXd H;  ///< 3 x n
};
/// Where the antenna is when a fix with the filter's time is valid: an estimated time offset moves it along.
[[nodiscard]] AntennaPrediction antenna_position(const FilterState& state, const UpdateContext& context);
[[nodiscard]] AntennaPrediction antenna_velocity(const FilterState& state, const UpdateContext& context);

/// H += factor * d(v_ea_e)/d(error), v_ea = v_eb + C (omega x l).
void add_antenna_velocity(const Antenna& antenna, const UpdateContext& context, double factor, Eigen::MatrixXd& H);

/// H += A d(omega_eb_b)/d(error): the gyro's estimated errors are in the rate. A is m x 3.
void add_rate(const Eigen::Matrix3d& A, const UpdateContext& context, Eigen::MatrixXd& H);

}  // namespace coast::estimate
