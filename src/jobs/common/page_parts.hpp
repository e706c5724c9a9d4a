#pragma once
// Parts of the pages of all jobs: formatted numbers, tables, curves.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "coast/record/event.hpp"
#include "coast/report/page.hpp"
#include "coast/report/panels.hpp"

namespace coast::jobs {

[[nodiscard]] report::Table event_table(const record::Events& events);

// --- formatted numbers

/// Three significant digits without exponent: "0.0123", "4.56", "1230".
[[nodiscard]] std::string number(double value, int significant = 3);
/// "0.12 / 0.34 / 0.56"
[[nodiscard]] std::string triple(const Eigen::Vector3d& values, int significant = 2);
/// A fixed number of decimals, never "-0.00".
[[nodiscard]] std::string decimals(double value, int count);
/// 0.934 -> "93.4"
[[nodiscard]] std::string percent(double share);
[[nodiscard]] std::string joined(const std::vector<std::string>& words, std::string_view between);
[[nodiscard]] std::vector<report::Cell> cells(std::initializer_list<std::string> texts);

// --- verdicts

/// Fraction of errors inside their predicted 95 % over a number of outages. Within one outage the errors of an axis are one
/// sample: good within three, to be checked within six standard deviations of 3 x outages independent errors.
[[nodiscard]] report::Verdict verdict_of_share(double inside_95, std::size_t outages);

// --- curves

inline const std::array<std::string, 3> kNed{"N", "E", "D"};
inline const std::array<std::string, 3> kEuler{"roll", "pitch", "yaw"};
inline constexpr std::array<report::Tone, 3> kComponentTones{report::Tone::kX, report::Tone::kY, report::Tone::kZ};

/// An existing curve, decimated. With `sd` (same length, else empty) a band of value -+ factor sd.
[[nodiscard]] report::Series curve(const std::vector<double>& x, const std::vector<double>& y,
                                   const std::vector<double>& sd = {}, double factor = 1.0, std::size_t most_points = 6000);
/// The values that determine the first view of y.
struct Bulk {
  double tail = 0.01;   ///< fraction of the values, on either side, that may lie outside
  double air = 0.3;     ///< margin above and below, as a fraction of the height between the quantiles
  double from_s = 0.0;  ///< earlier values are ignored
};
inline constexpr Bulk kMotion{};           ///< all parts equally important
inline constexpr Bulk kErrors{0.05, 1.0};  ///< for normal errors without outages: about five sigma
/// Sets the first view of y by quantiles if the full range is more than 1.5 times as high, so that a start transient or
/// an outage does not flatten the rest. Zooming in x, or Shift and wheel, shows all; the caption explains it.
void show_bulk(report::Panel& panel, const Bulk& bulk = kMotion);

}  // namespace coast::jobs
