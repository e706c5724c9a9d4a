#pragma once
// Transfers the gyro biases of the alignment to the initial filter state; private to the room.

#include "coast/estimate/filter_state.hpp"
#include "coast/estimate/state_layout.hpp"

namespace coast::study {

/// A bias known in body axes becomes the state of the additive process with the largest prior on each axis, minus known values
/// of other states. In a synthetic IMU every member has such a state, and the bias is distributed by prior and weight.
/// @param bias_b  rad/s
void set_gyro_bias(const estimate::StateLayout& layout, Eigen::Vector3d bias_b, estimate::FilterState& state);

/// A bias estimated at standstill is known far better than a turn-on bias. With the turn-on prior, the heading of a consumer
/// IMU (1 deg/s) would be unknown before it first moves, and a filter linear in the attitude cannot recover it.
/// @param sd  of each component, rad/s
void know_gyro_bias(const estimate::StateLayout& layout, double sd, Eigen::MatrixXd& P);

}  // namespace coast::study
