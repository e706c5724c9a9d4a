// Section: errors relative to a reference trajectory.

#include <fmt/format.h>

#include <functional>

#include "coast/geo/units.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

/// One vector of the errors: its curves, its part of the summary, its unit.
struct Quantity {
  const char* id;
  const char* title;
  const char* unit;
  double to_si;
  std::array<std::string, 3> components;
  const ReferenceErrors::Curves& (ReferenceErrors::*curves)() const;
  std::function<study::AxisErrors(const study::ErrorSummary&)> of;
  bool has_sd;
};

/// The decimated curve in the unit of the panel.
report::Series curve_of(const ReferenceErrors& errors, const Quantity& q, std::size_t axis, bool band) {
  report::Series series = (errors.*q.curves)()[axis].finish();
  const auto scale = [&q](std::vector<double>& values) {
    for (double& value : values) value /= q.to_si;
  };
  scale(series.y);
  if (!band) series.band.reset();
  if (series.band) {
    scale(series.band->lower);
    scale(series.band->upper);
  }
  return series;
}

report::Panel error_panel(const ProcessPage& page, const Quantity& q) {
  const AgainstReference& r = *page.result.reference;
  report::Panel panel =
      report::stacked_time_panel(q.id, q.title, {q.components.begin(), q.components.end()}, q.unit,
                                 q.has_sd ? "Estimate minus reference; two thirds inside the predicted one-sigma band is good."
                                          : "Estimate minus reference; around zero without trend is good.");
  for (std::size_t i = 0; i < 3; ++i) {
    report::Line& forward =
        report::add_line(panel.plots[i], "forward", curve_of(r.forward, q, i, !r.smoothed && q.has_sd), report::Tone::kForward);
    if (!r.smoothed) {
      if (q.has_sd) forward.band_label = "1 sigma";
      continue;
    }
    report::Line& line =
        report::add_line(panel.plots[i], "smoothed", curve_of(*r.smoothed, q, i, q.has_sd), report::Tone::kSmoothed);
    if (q.has_sd) line.band_label = "1 sigma";
  }
  report::shade(panel, outage_intervals(page));
  show_bulk(panel, kErrors);
  return panel;
}

/// Errors of adjacent epochs are correlated: only their fraction over a whole mission is judged, and with a margin.
report::Cell share_inside_cell(const study::AxisErrors& errors, Eigen::Index axis) {
  constexpr double kGood = 0.90;
  constexpr double kTooSmall = 0.75;  // sigmas that are 1.7 times too small
  constexpr double kCautious = 0.98;
  if (!errors.inside_95) return {};
  const double inside = (*errors.inside_95)(axis);
  const report::Verdict verdict = inside < kTooSmall   ? report::Verdict::kBad
                                  : inside < kGood     ? report::Verdict::kWarn
                                  : inside > kCautious ? report::Verdict::kNone
                                                       : report::Verdict::kGood;
  return {percent(inside), verdict};
}

report::Table error_table(const AgainstReference& r, const std::vector<Quantity>& quantities) {
  const study::ErrorSummary forward_summary = r.summary(r.forward);
  report::Table table;
  table.id = "reference-table";
  table.title = "Errors against the reference";
  table.caption = fmt::format(
      "Over {} epochs of the reference. Inside 95 %: within 1.96 predicted sigma; 90 to 98 % is good, more "
      "is cautious, below 75 % the sigmas are too small.",
      forward_summary.epochs);
  table.columns = {{"error", "", false}, {"unit", "", false},  {"forward rms", ""},          {"forward max", ""},
                   {"smoothed rms", ""}, {"smoothed max", ""}, {"forward inside 95 %", "%"}, {"smoothed inside 95 %", "%"}};
  for (const Quantity& q : quantities) {
    const study::AxisErrors forward = q.of(forward_summary);
    std::optional<study::AxisErrors> smoothed;
    if (r.smoothed) smoothed = q.of(r.summary(*r.smoothed));
    const auto value = [&q](double si) { return number(si / q.to_si); };
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      auto row = cells({q.components[i], q.unit, value(forward.rms(axis)), value(forward.max(axis)),
                        smoothed ? value(smoothed->rms(axis)) : "", smoothed ? value(smoothed->max(axis)) : ""});
      row.push_back(share_inside_cell(forward, axis));
      row.push_back(smoothed ? share_inside_cell(*smoothed, axis) : report::Cell{});
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

}  // namespace

std::optional<report::Section> reference_section(const ProcessPage& page) {
  if (!page.result.reference || page.result.reference->summary(page.result.reference->forward).epochs == 0) return std::nullopt;
  const AgainstReference& r = *page.result.reference;
  using study::ErrorSummary;
  std::vector<Quantity> quantities{{"error-position", "Position error", "m", 1.0, kNed, &ReferenceErrors::position,
                                    [](const ErrorSummary& s) { return s.position; }, true}};
  if (r.has_velocity)
    quantities.push_back({"error-velocity",
                          "Velocity error",
                          "m/s",
                          1.0,
                          {"vN", "vE", "vD"},
                          &ReferenceErrors::velocity,
                          [](const ErrorSummary& s) { return *s.velocity; },
                          false});
  if (r.has_attitude)
    quantities.push_back({"error-attitude", "Attitude error", "deg", geo::kDegree, kEuler, &ReferenceErrors::attitude,
                          [](const ErrorSummary& s) { return *s.attitude; }, true});
  report::Section section;
  section.id = "reference";
  section.title = "Against the reference";
  section.lead = "At the epochs of the reference and at its point, in its N, E, D. Its own errors are part of what is seen.";
  section.tables.push_back(error_table(r, quantities));
  for (const Quantity& q : quantities) section.panels.push_back(error_panel(page, q));
  return section;
}

}  // namespace coast::jobs
