#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "coast/record/event.hpp"
#include "coast/study/comparison.hpp"

namespace coast::jobs {

[[nodiscard]] nlohmann::ordered_json array_json(const Eigen::Vector3d& v);
/// rad to an array of degrees
[[nodiscard]] nlohmann::ordered_json degrees_json(const Eigen::Vector3d& v);
/// Errors relative to a reference as in summary.json and comparison.json.
[[nodiscard]] nlohmann::ordered_json error_json(const study::ErrorSummary& errors);
/// As in summary.json and ppk.json.
[[nodiscard]] nlohmann::ordered_json events_json(const record::Events& events);

}  // namespace coast::jobs
