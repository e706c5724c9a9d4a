#include <fmt/format.h>

#include "coast/report/panels.hpp"
#include "drift.hpp"
#include "outage_page.hpp"

namespace coast::cli {

report::Section sweep_section(const std::string& model, const std::vector<study::OutageResult>& results, std::size_t number) {
  report::Section section;
  section.id = fmt::format("model-{}", number);
  section.title = model;
  report::Table table;
  table.id = section.id + "-table";
  table.title = "Largest horizontal error of an outage";
  table.columns = {{"duration", "s"},        {"outages", ""},        {"forward median", "m"},   {"forward 95 %", "m"},
                   {"smoothed median", "m"}, {"smoothed 95 %", "m"}, {"inside 95 % bound", "%"}};
  report::Panel panel = report::xy_panel(
      section.id + "-drift", "Drift against duration",
      {.label = "duration", .unit = "s", .scale = report::Axis::Scale::kLog, .ticks = {}, .range = {}},
      {.label = "largest horizontal error", .unit = "m", .scale = report::Axis::Scale::kLog, .ticks = {}, .range = {}},
      "Median and 95 % over all outages of a duration; smoothed lies far below forward.");
  report::Series forward;
  report::Series forward95;
  report::Series smoothed;
  report::Series smoothed95;
  const auto push = [](report::Series& s, double x, double y) {
    s.x.push_back(x);
    s.y.push_back(y);
  };
  for (const DriftRow& row : drift_table(results)) {
    table.rows.push_back({{fmt::format("{:g}", row.duration_s)},
                          {fmt::format("{}", row.outages)},
                          {fmt::format("{:.3f}", row.forward.median)},
                          {fmt::format("{:.3f}", row.forward.p95)},
                          {fmt::format("{:.3f}", row.smoothed.median)},
                          {fmt::format("{:.3f}", row.smoothed.p95)},
                          {fmt::format("{:.1f}", 100.0 * row.inside_95)}});
    push(forward, row.duration_s, row.forward.median);
    push(forward95, row.duration_s, row.forward.p95);
    push(smoothed, row.duration_s, row.smoothed.median);
    push(smoothed95, row.duration_s, row.smoothed.p95);
  }
  report::add_line(panel.plot(), "forward, median", forward, report::Tone::kForward);
  report::add_line(panel.plot(), "forward, 95 %", forward95, report::Tone::kForward).style = report::Line::Style::kDashed;
  report::add_line(panel.plot(), "smoothed, median", smoothed, report::Tone::kSmoothed);
  report::add_line(panel.plot(), "smoothed, 95 %", smoothed95, report::Tone::kSmoothed).style = report::Line::Style::kDashed;
  section.tables.push_back(std::move(table));
  section.panels.push_back(std::move(panel));
  return section;
}

}  // namespace coast::cli
