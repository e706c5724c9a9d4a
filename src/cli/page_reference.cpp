// Section: errors against a reference trajectory.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/units.hpp"
#include "page_parts.hpp"

namespace coast::cli {

namespace {

/// One quantity of the error samples: which vector, its sigma where there is one, its unit.
struct Quantity {
  const char* id;
  const char* title;
  const char* unit;
  double to_si;
  std::array<std::string, 3> components;
  Eigen::Vector3d study::ErrorSample::*value;
  Eigen::Vector3d study::ErrorSample::*sd;  ///< nullptr: none
};

report::Series errors_of(const ProcessPage& page, const std::vector<study::ErrorSample>& errors, const Quantity& q,
                         Eigen::Index axis, bool band) {
  report::Decimator decimator({12000, 5.0});
  for (const study::ErrorSample& e : errors) {
    const double t = seconds_since_start(page, e.t);
    const double value = (e.*q.value)(axis) / q.to_si;
    if (band && q.sd != nullptr) {
      const double sd = (e.*q.sd)(axis) / q.to_si;
      decimator.add(t, value, -sd, sd);
    } else {
      decimator.add(t, value);
    }
  }
  return decimator.finish();
}

report::Panel error_panel(const ProcessPage& page, const Quantity& q) {
  const AgainstReference& r = *page.result.reference;
  report::Panel panel = report::stacked_time_panel(
      q.id, q.title, {q.components.begin(), q.components.end()}, q.unit,
      q.sd != nullptr ? "Estimate minus reference; two thirds inside the predicted one-sigma band is good."
                      : "Estimate minus reference; around zero without trend is good.");
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const bool smoothed = !r.smoothed_errors.empty();
    report::Line& forward = report::add_line(panel.plots[i], "forward", errors_of(page, r.forward_errors, q, axis, !smoothed),
                                             report::Tone::kForward);
    if (!smoothed) {
      if (q.sd != nullptr) forward.band_label = "1 sigma";
      continue;
    }
    report::Line& line = report::add_line(panel.plots[i], "smoothed", errors_of(page, r.smoothed_errors, q, axis, true),
                                          report::Tone::kSmoothed);
    if (q.sd != nullptr) line.band_label = "1 sigma";
  }
  report::shade(panel, outage_intervals(page));
  show_bulk(panel, kErrors);
  return panel;
}

/// Root mean square, largest absolute value, and share within 1.96 predicted sigma, axis by axis.
struct Statistics {
  Eigen::Vector3d rms = Eigen::Vector3d::Zero();
  Eigen::Vector3d largest = Eigen::Vector3d::Zero();
  Eigen::Vector3d inside = Eigen::Vector3d::Zero();
};

/// @param errors  not empty
Statistics statistics(const std::vector<study::ErrorSample>& errors, const Quantity& q) {
  Statistics s;
  for (const study::ErrorSample& e : errors) {
    const Eigen::Array3d size = (e.*q.value).array().abs();
    s.rms.array() += size.square();
    s.largest = s.largest.cwiseMax(size.matrix());
    if (q.sd != nullptr) s.inside.array() += (size <= 1.96 * (e.*q.sd).array()).cast<double>();
  }
  const double n = static_cast<double>(errors.size());
  s.rms = (s.rms / n).cwiseSqrt() / q.to_si;
  s.largest /= q.to_si;
  s.inside /= n;
  return s;
}

report::Table error_table(const AgainstReference& r, const std::vector<Quantity>& quantities) {
  report::Table table;
  table.id = "reference-table";
  table.title = "Errors against the reference";
  table.caption = fmt::format("Over {} epochs of the reference. Inside 95 %: within 1.96 predicted sigma; 90 to 98 % is good.",
                              r.forward.epochs);
  table.columns = {{"error", "", false}, {"unit", "", false},  {"forward rms", ""},          {"forward max", ""},
                   {"smoothed rms", ""}, {"smoothed max", ""}, {"forward inside 95 %", "%"}, {"smoothed inside 95 %", "%"}};
  for (const Quantity& q : quantities) {
    const Statistics forward = statistics(r.forward_errors, q);
    std::optional<Statistics> smoothed;
    if (!r.smoothed_errors.empty()) smoothed = statistics(r.smoothed_errors, q);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      table.rows.push_back(cells({q.components[i], q.unit, number(forward.rms(axis)), number(forward.largest(axis)),
                                  smoothed ? number(smoothed->rms(axis)) : "", smoothed ? number(smoothed->largest(axis)) : "",
                                  q.sd != nullptr ? percent(forward.inside(axis)) : "",
                                  q.sd != nullptr && smoothed ? percent(smoothed->inside(axis)) : ""}));
    }
  }
  return table;
}

}  // namespace

std::optional<report::Section> reference_section(const ProcessPage& page) {
  if (!page.result.reference || page.result.reference->forward_errors.empty()) return std::nullopt;
  const AgainstReference& r = *page.result.reference;
  using study::ErrorSample;
  std::vector<Quantity> quantities{
      {"error-position", "Position error", "m", 1.0, kNed, &ErrorSample::position_n, &ErrorSample::sd_position}};
  if (r.has_velocity)
    quantities.push_back(
        {"error-velocity", "Velocity error", "m/s", 1.0, {"vN", "vE", "vD"}, &ErrorSample::velocity_n, nullptr});
  if (r.has_attitude)
    quantities.push_back(
        {"error-attitude", "Attitude error", "deg", geo::kDegree, kEuler, &ErrorSample::attitude, &ErrorSample::sd_attitude});
  report::Section section;
  section.id = "reference";
  section.title = "Against the reference";
  section.lead = "At the epochs of the reference and at its point, in its N, E, D. Its own errors are part of what is seen.";
  section.tables.push_back(error_table(r, quantities));
  for (const Quantity& q : quantities) section.panels.push_back(error_panel(page, q));
  return section;
}

}  // namespace coast::cli
