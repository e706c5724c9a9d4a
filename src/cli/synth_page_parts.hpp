#pragma once
// The sections of the page of `coast synth`, one file each.

#include "synth_page.hpp"

namespace coast::cli {

/// Clocks, lags and sampling intervals; how the sensors sit; which were left out.
[[nodiscard]] report::Section array_time_section(const ArrayConfig& config, const SynthResult& result);
[[nodiscard]] report::Section array_mounting_section(const ArrayConfig& config, const SynthResult& result);
[[nodiscard]] report::Section array_defect_section(const ArrayConfig& config, const SynthResult& result);
/// Noise of the sensors and of what was merged: over time, as box plots, and the models behind it.
[[nodiscard]] report::Section array_noise_section(const ArrayConfig& config, const SynthResult& result);

/// Seconds of the middle of sample n since the start of the grid.
[[nodiscard]] inline double grid_seconds(const SynthResult& result, double n) {
  return (n + 0.5) * result.assembly.signals.dt;
}

}  // namespace coast::cli
