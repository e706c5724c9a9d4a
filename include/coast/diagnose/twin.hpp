#pragma once
// What a model says that a mission would have recorded.

#include <cstdint>

#include "coast/diagnose/correction.hpp"

namespace coast::diagnose {

/// A recording of the same motion by sensors that are as the setup says: increments along the trajectory with errors drawn from
/// the error model, fixes at the recorded epochs with errors of their stated (and scaled) sigmas, white and correlated.
/// @param path   smoothed, at IMU epochs. Its rates and velocities are kept, its positions follow from them
/// @param model  recordings for their epochs, setup for lever arm, time offset, noise
[[nodiscard]] MissionInput twin(const std::vector<record::NavState>& path, const MissionInput& model, std::uint64_t seed);

}  // namespace coast::diagnose
