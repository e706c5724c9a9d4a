#pragma once
// The page of `coast calibrate`.

#include "calibration_result.hpp"
#include "coast/report/page.hpp"

namespace coast::cli {

/// Draws realisations and smooths each record again, on all cores: some passes over the records.
[[nodiscard]] report::Page calibration_page(const CalibrationConfig& config, const CalibrationResult& result);

}  // namespace coast::cli
