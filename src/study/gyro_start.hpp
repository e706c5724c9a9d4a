#pragma once
// What the alignment knows of the gyros, in the states that a filter starts with; private to the room.

#include "coast/estimate/filter_state.hpp"
#include "coast/estimate/state_layout.hpp"

namespace coast::study {

/// A bias known in body axes becomes the state of the additive process with the largest prior on each axis, less what other
/// states are known to be. Of a synthetic IMU every member has such a state, and each takes what its prior and its weight say.
/// @param bias_b  rad/s
void set_gyro_bias(const estimate::StateLayout& layout, Eigen::Vector3d bias_b, estimate::FilterState& state);

/// A bias seen standing still is known far better than a turn-on bias. At its prior, the heading of a consumer IMU (1 deg/s)
/// would be unknown before it first moves, and no filter linear in the attitude finds it again.
/// @param sd  of each component, rad/s
void know_gyro_bias(const estimate::StateLayout& layout, double sd, Eigen::MatrixXd& P);

}  // namespace coast::study
