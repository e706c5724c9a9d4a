#pragma once
// Simulated recording of a mission according to a model.

#include <cstdint>

#include "coast/diagnose/correction.hpp"

namespace coast::diagnose {

/// A simulated recording of the same motion by sensors as described in the setup: increments along the trajectory with errors
/// drawn from the error model, fixes at the recorded epochs with errors of their stated (and scaled) sigmas, white and
/// correlated.
/// @param path   smoothed, at IMU epochs. Its rates and velocities are kept, its positions are integrated from them
/// @param model  gives the epochs (recordings), and lever arm, time offset, noise (setup)
[[nodiscard]] MissionInput twin(const std::vector<record::NavState>& path, const MissionInput& model, std::uint64_t seed);

}  // namespace coast::diagnose
