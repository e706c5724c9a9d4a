#pragma once
// `effects` of a run file: findings of `coast diagnose`, by name.

#include <vector>

#include "coast/config/node.hpp"
#include "coast/diagnose/correction.hpp"

namespace coast::jobs {

/// effects: [{name: gyro_g_sensitivity, sensor: gyro, axis: zy, value: 2e-6, start_s: .., end_s: ..}]
/// @throws InputError  unknown effect, sensor, axis or relation; with file and line
[[nodiscard]] std::vector<diagnose::NamedEffect> read_effects(const config::Node& list);

}  // namespace coast::jobs
