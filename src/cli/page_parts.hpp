#pragma once
// What the sections of the process page share, and the sections themselves: one file each, page_<section>.cpp.
// A section without data is absent; a panel without data is left out of its section.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "coast/report/page.hpp"
#include "coast/report/panels.hpp"
#include "process_page.hpp"

namespace coast::cli {

// --- sections, in the order of the page

[[nodiscard]] std::vector<report::Tile> acceptance_tiles(const ProcessPage& page);
[[nodiscard]] report::Section input_section(const ProcessPage& page);
[[nodiscard]] report::Section trajectory_section(const ProcessPage& page);
[[nodiscard]] report::Section motion_section(const ProcessPage& page);  ///< N, E, D, velocity, attitude and their sigmas
[[nodiscard]] std::optional<report::Section> separation_section(const ProcessPage& page);
[[nodiscard]] std::optional<report::Section> innovation_section(const ProcessPage& page);
[[nodiscard]] report::Section sensor_section(const ProcessPage& page);
[[nodiscard]] std::optional<report::Section> batch_section(const ProcessPage& page);
[[nodiscard]] report::Section body_section(const ProcessPage& page);
[[nodiscard]] std::optional<report::Section> outage_section(const ProcessPage& page);
[[nodiscard]] std::optional<report::Section> reference_section(const ProcessPage& page);
[[nodiscard]] report::Section processing_section(const ProcessPage& page);

// --- panels of one section that have a file of their own

/// Drift against duration, as figure and table, and where the largest errors were.
void add_sweep(const ProcessPage& page, report::Section& section);
/// Noise found by innovation likelihood: table and plain sentences.
void add_noise_fit(const ProcessPage& page, report::Section& section);
[[nodiscard]] report::Table event_table(const record::Events& events);

// --- numbers for people

/// Three significant digits without exponent: "0.0123", "4.56", "1230".
[[nodiscard]] std::string number(double value, int significant = 3);
/// "0.12 / 0.34 / 0.56"
[[nodiscard]] std::string triple(const Eigen::Vector3d& values, int significant = 2);
/// A number of decimals, never "-0.00".
[[nodiscard]] std::string decimals(double value, int count);
/// 0.934 -> "93.4"
[[nodiscard]] std::string percent(double share);
[[nodiscard]] std::string joined(const std::vector<std::string>& words, std::string_view between);
[[nodiscard]] std::vector<report::Cell> cells(std::initializer_list<std::string> texts);

// --- times

[[nodiscard]] double seconds_since_start(const ProcessPage& page, geo::GpsTime t);
/// GNSS that was withheld from the delivered trajectory.
[[nodiscard]] std::vector<report::Interval> outage_intervals(const ProcessPage& page);
/// Times of the fixes inside them.
[[nodiscard]] std::vector<geo::GpsTime> withheld_fixes(const ProcessPage& page);

// --- verdicts

/// Share of errors inside their predicted 95 % over a number of outages. Within one outage the errors of an axis are one draw:
/// good within three, to be looked at within six standard deviations of 3 x outages independent errors.
[[nodiscard]] report::Verdict verdict_of_share(double inside_95, std::size_t outages);

// --- curves

inline const std::array<std::string, 3> kNed{"N", "E", "D"};
inline const std::array<std::string, 3> kEuler{"roll", "pitch", "yaw"};
inline constexpr std::array<report::Tone, 3> kComponentTones{report::Tone::kX, report::Tone::kY, report::Tone::kZ};

/// "smoothed", or "forward" where no smoother ran.
[[nodiscard]] std::string delivered(const ProcessPage& page);
[[nodiscard]] report::Tone delivered_tone(const ProcessPage& page);
/// A curve at hand, decimated. With `sd` (same length, else empty) a band of value -+ factor sd.
[[nodiscard]] report::Series curve(const std::vector<double>& x, const std::vector<double>& y,
                                   const std::vector<double>& sd = {}, double factor = 1.0, std::size_t most_points = 6000);
/// Which part of the values the first view of y is made for.
struct Bulk {
  double tail = 0.01;   ///< share of the values, on either side, that may lie outside
  double air = 0.3;     ///< added above and below, as a share of the height between the quantiles
  double from_s = 0.0;  ///< values before do not count
};
inline constexpr Bulk kMotion{};           ///< of which every part is as good as another
inline constexpr Bulk kErrors{0.05, 1.0};  ///< of normal errors without outages: about five sigma
/// Sets the first view of y by quantiles where the whole would be half as high again, so that a start transient or
/// an outage does not flatten the rest. Zooming in x, or Shift and wheel, shows all; the caption says so.
void show_bulk(report::Panel& panel, const Bulk& bulk = kMotion);

}  // namespace coast::cli
