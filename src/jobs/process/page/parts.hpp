#pragma once
// The sections of the process page, one file each, and shared functions. A section without data is omitted; so is a panel
// without data.

#include <optional>
#include <string>
#include <vector>

#include "common/page_parts.hpp"
#include "process/page/page.hpp"

namespace coast::jobs {

// --- sections, in the order of the page

[[nodiscard]] std::vector<report::Tile> acceptance_tiles(const ProcessPage& page);
[[nodiscard]] report::Section input_section(const ProcessPage& page);
[[nodiscard]] report::Section trajectory_section(const ProcessPage& page);
[[nodiscard]] report::Section accuracy_section(const ProcessPage& page);
[[nodiscard]] report::Section motion_section(const ProcessPage& page);  ///< N, E, D, velocity, attitude and their sigmas
[[nodiscard]] std::optional<report::Section> separation_section(const ProcessPage& page);
[[nodiscard]] std::optional<report::Section> innovation_section(const ProcessPage& page);
[[nodiscard]] report::Section sensor_section(const ProcessPage& page);
[[nodiscard]] std::optional<report::Section> batch_section(const ProcessPage& page);
[[nodiscard]] report::Section body_section(const ProcessPage& page);
[[nodiscard]] std::optional<report::Section> outage_section(const ProcessPage& page);
[[nodiscard]] std::optional<report::Section> reference_section(const ProcessPage& page);
[[nodiscard]] report::Section processing_section(const ProcessPage& page);

// --- panels with a file of their own

/// Drift as function of duration, as figure and table, and the places of the largest errors.
void add_sweep(const ProcessPage& page, report::Section& section);
/// Noise fitted by innovation likelihood: table and text.
void add_noise_fit(const ProcessPage& page, report::Section& section);
/// Innovations and counts of aiding sensors.
void add_aids(const ProcessPage& page, report::Section& section);

// --- times

[[nodiscard]] double seconds_since_start(const ProcessPage& page, geo::GpsTime t);
/// Intervals of GNSS withheld from the delivered trajectory.
[[nodiscard]] std::vector<report::Interval> outage_intervals(const ProcessPage& page);
/// Times of the fixes inside them.
[[nodiscard]] std::vector<geo::GpsTime> withheld_fixes(const ProcessPage& page);

/// "smoothed", or "forward" without smoother.
[[nodiscard]] std::string delivered(const ProcessPage& page);
[[nodiscard]] report::Tone delivered_tone(const ProcessPage& page);
}  // namespace coast::jobs
