#pragma once
// The page of `coast ppk`.

#include "coast/report/page.hpp"
#include "ppk/summary.hpp"

namespace coast::jobs {

[[nodiscard]] report::Page ppk_page(const PpkConfig& config, const PpkResult& result);

// --- its sections, one file per section

[[nodiscard]] report::Section ppk_position_section(const PpkResult& result);
[[nodiscard]] report::Section ppk_quality_section(const PpkResult& result);
[[nodiscard]] report::Section ppk_satellite_section(const PpkResult& result);
[[nodiscard]] report::Section ppk_residual_section(const PpkResult& result);

/// Seconds since the first epoch.
[[nodiscard]] double seconds(const PpkResult& result, const carrier::PpkEpoch& epoch);

}  // namespace coast::jobs
