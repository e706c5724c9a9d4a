#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "coast/record/event.hpp"
#include "coast/study/comparison.hpp"

namespace coast::cli {

[[nodiscard]] nlohmann::ordered_json array_json(const Eigen::Vector3d& v);
/// rad to an array of degrees
[[nodiscard]] nlohmann::ordered_json degrees_json(const Eigen::Vector3d& v);
/// Errors against a reference as summary.json and comparison.json have them.
[[nodiscard]] nlohmann::ordered_json error_json(const study::ErrorSummary& errors);
/// As summary.json and ppk.json have them.
[[nodiscard]] nlohmann::ordered_json events_json(const record::Events& events);

}  // namespace coast::cli
