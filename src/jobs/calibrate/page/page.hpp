#pragma once
// The page of `coast calibrate`.

#include "calibrate/result.hpp"
#include "coast/report/page.hpp"

namespace coast::jobs {

/// Simulates realisations and smooths each record again, on all cores: takes several passes over the records.
[[nodiscard]] report::Page calibration_page(const CalibrationConfig& config, const CalibrationResult& result);

}  // namespace coast::jobs
