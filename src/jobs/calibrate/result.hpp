#pragma once
// A calibration as text.

#include <string>

#include "coast/jobs/calibrate.hpp"

namespace coast::jobs {

/// error_model.yaml: the chosen model, as input of `coast process`, with the source of each value.
[[nodiscard]] std::string error_model_yaml(const CalibrationConfig& config, const CalibrationResult& result);
/// calibration.json (docs/schema/calibration.schema.json).
[[nodiscard]] std::string calibration_json(const CalibrationConfig& config, const CalibrationResult& result);
/// A few lines per axis for the terminal.
[[nodiscard]] std::string calibration_text(const CalibrationResult& result);

}  // namespace coast::jobs
