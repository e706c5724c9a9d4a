#pragma once
// Results of a multi-position calibration as JSON, text and page.

#include <string>

#include "coast/jobs/tumble.hpp"
#include "coast/report/page.hpp"

namespace coast::jobs {

/// tumble.json (docs/schema/tumble_result.schema.json).
[[nodiscard]] std::string tumble_json(const TumbleConfig& config, const TumbleResult& result);
[[nodiscard]] report::Page tumble_page(const TumbleConfig& config, const TumbleResult& result);

/// Largest standard deviation of a gain of one triad (record::ImuCalibration::kAccel or kGyro).
[[nodiscard]] double largest_gain_sd(const record::ImuCalibration& calibration, int triad);
/// Root mean square over the rests (turns) that were used.
[[nodiscard]] double force_rms(const tumble::Result& result);  ///< m/s^2
[[nodiscard]] double turn_rms(const tumble::Result& result);   ///< rad
/// A direction in words of the axes: "x up", "y down", "z up, 35 deg towards -x".
[[nodiscard]] std::string direction_text(const Eigen::Vector3d& up);

}  // namespace coast::jobs
