#pragma once
// `effects` of a run file: what `coast diagnose` found, by name.

#include <vector>

#include "coast/config/node.hpp"
#include "coast/diagnose/correction.hpp"

namespace coast::cli {

/// effects: [{name: gyro_g_sensitivity, sensor: gyro, axis: zy, value: 2e-6, start_s: .., end_s: ..}]
/// @throws InputError  an effect, a sensor, an axis or a relation that there is not; with file and line
[[nodiscard]] std::vector<diagnose::NamedEffect> read_effects(const config::Node& list);

}  // namespace coast::cli
