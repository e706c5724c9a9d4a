// Drift as function of the duration of an outage, over many outages.

#include <fmt/format.h>

#include "common/drift.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

/// One quantile of one solution over the durations.
report::Series over_durations(const std::vector<DriftRow>& rows, study::Drift DriftRow::*solution,
                              double study::Spread::*quantile_of) {
  report::Series series;
  for (const DriftRow& row : rows) {
    series.x.push_back(row.duration_s);
    series.y.push_back((row.*solution).horizontal.*quantile_of);
  }
  return series;
}

void add_quantiles(report::Plot& plot, const std::vector<DriftRow>& rows, study::Drift DriftRow::*solution,
                   const std::string& name, report::Tone tone) {
  report::Line& median = report::add_line(plot, name + " median", over_durations(rows, solution, &study::Spread::median), tone);
  median.width_px = 2.4;
  report::add_line(plot, name + " 68 %", over_durations(rows, solution, &study::Spread::p68), tone).width_px = 1.0;
  report::add_line(plot, name + " 95 %", over_durations(rows, solution, &study::Spread::p95), tone).style =
      report::Line::Style::kDashed;
  report::add_points(plot, name + " largest", over_durations(rows, solution, &study::Spread::max), tone).radius_px = 3.0;
}

report::Panel drift_panel(const std::vector<DriftRow>& rows) {
  report::Panel panel =
      report::xy_panel("drift", "Drift against duration", {"duration of the outage", "s", report::Axis::Scale::kLog, {}, {}},
                       {"largest horizontal error", "m", report::Axis::Scale::kLog, {}, {}},
                       "Straight lines are good; forward grows with the power 1.5 (noise) to 3 (gyro bias), the distance to "
                       "smoothed is what the "
                       "smoother gains.");
  add_quantiles(panel.plot(), rows, &DriftRow::forward, "forward", report::Tone::kForward);
  add_quantiles(panel.plot(), rows, &DriftRow::smoothed, "smoothed", report::Tone::kSmoothed);
  panel.plot().height_px = 380;
  return panel;
}

report::Table drift_table_of(const ProcessPage& page, const std::vector<DriftRow>& rows) {
  report::Table table;
  table.id = "drift-table";
  table.title = "Drift by duration";
  table.caption = fmt::format(
      "Largest horizontal error of each outage against {}{}; quantiles over the outages. Inside: share of the errors, axis by "
      "axis, "
      "within their predicted 95 %.",
      page.result.compared_with == "reference" ? "the reference" : "the run without gaps",
      rows.front().forward.against_gnss ? " and against the withheld fixes (GNSS)" : "");
  table.columns = {{"duration", "s"}, {"outages", ""}, {"solution", "", false}, {"median", "m"},
                   {"68 %", "m"},     {"95 %", "m"},   {"largest", "m"},        {"inside", "%"}};
  const bool gnss = rows.front().forward.against_gnss.has_value();
  if (gnss) table.columns.push_back({"median, GNSS", "m"});
  for (const DriftRow& row : rows)
    for (const bool smoothed : {false, true}) {
      const study::Drift& drift = smoothed ? row.smoothed : row.forward;
      auto line = cells({fmt::format("{:g}", row.duration_s), fmt::format("{}", row.outages), smoothed ? "smoothed" : "forward",
                         number(drift.horizontal.median), number(drift.horizontal.p68), number(drift.horizontal.p95),
                         number(drift.horizontal.max), percent(drift.inside_95)});
      line.back().verdict = verdict_of_share(drift.inside_95, row.outages);
      if (gnss) line.push_back({drift.against_gnss ? number(drift.against_gnss->median) : ""});
      table.rows.push_back(std::move(line));
    }
  return table;
}

/// Each outage at its start, so that a bad stretch of road is visible.
report::Panel where_panel(const ProcessPage& page, const std::vector<DriftRow>& rows) {
  report::Panel panel =
      report::time_panel("drift-where", "Where it drifts", "m",
                         "Largest horizontal error of each outage at its start, smoothed; peaks at one place name "
                         "a manoeuvre or a bad stretch of GNSS.");
  report::Plot& plot = panel.plot();
  plot.y.label = "largest error";
  plot.y.scale = report::Axis::Scale::kLog;
  for (const DriftRow& row : rows) {
    report::Series series;
    for (const study::OutageResult& o : page.result.sweep) {
      if (o.outage.duration_s != row.duration_s || !o.smoothed) continue;
      series.x.push_back(seconds_since_start(page, o.outage.start));
      series.y.push_back(o.smoothed->horizontal_max_m);
    }
    report::add_points(plot, fmt::format("{:g} s", row.duration_s), std::move(series)).radius_px = 3.0;
  }
  return panel;
}

}  // namespace

void add_sweep(const ProcessPage& page, report::Section& section) {
  const std::vector<DriftRow> rows = drift_table(page.result.sweep);
  if (rows.empty()) return;
  section.tables.push_back(drift_table_of(page, rows));
  section.panels.push_back(drift_panel(rows));
  section.panels.push_back(where_panel(page, rows));
}

}  // namespace coast::jobs
