#pragma once
// The sections of the page of `coast synth`, one file each.

#include "synth/page/page.hpp"

namespace coast::jobs {

/// Clocks, lags and sampling intervals; mounting of the sensors; excluded sensors.
[[nodiscard]] report::Section array_time_section(const ArrayConfig& config, const SynthResult& result);
[[nodiscard]] report::Section array_mounting_section(const ArrayConfig& config, const SynthResult& result);
[[nodiscard]] report::Section array_defect_section(const ArrayConfig& config, const SynthResult& result);
/// Noise of the sensors and of the merged signal: over time, as box plots, and their models.
[[nodiscard]] report::Section array_noise_section(const ArrayConfig& config, const SynthResult& result);

/// Time of the middle of sample n since the start of the grid, s.
[[nodiscard]] inline double grid_seconds(const SynthResult& result, double n) {
  return (n + 0.5) * result.assembly.signals.dt;
}

}  // namespace coast::jobs
