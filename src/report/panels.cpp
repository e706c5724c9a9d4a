#include "coast/report/panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coast/record/gnss.hpp"

namespace coast::report {
namespace {

constexpr int kStackedHeight = 150;
constexpr int kCellHeight = 170;
constexpr int kPlanHeight = 560;

Axis time_axis() {
  return {"time since start", "s", Axis::Scale::kTime, {}, {}};
}

Axis linear_axis(std::string label, std::string unit) {
  return {std::move(label), std::move(unit), Axis::Scale::kLinear, {}, {}};
}

Panel panel_with(std::string id, std::string title, std::string caption, int columns) {
  return {std::move(id), std::move(title), std::move(caption), columns, {}};
}

}  // namespace

Panel time_panel(std::string id, std::string title, std::string unit, std::string caption) {
  Panel panel = panel_with(std::move(id), std::move(title), std::move(caption), 1);
  Plot& plot = panel.plots.emplace_back();
  plot.x = time_axis();
  plot.y = linear_axis({}, std::move(unit));
  return panel;
}

Panel stacked_time_panel(std::string id, std::string title, const std::vector<std::string>& components, const std::string& unit,
                         std::string caption) {
  Panel panel = panel_with(std::move(id), std::move(title), std::move(caption), 1);
  for (const std::string& component : components) {
    Plot& plot = panel.plots.emplace_back();
    plot.x = time_axis();
    plot.y = linear_axis(component, unit);
    plot.height_px = kStackedHeight;
  }
  return panel;
}

Panel plan_panel(std::string id, std::string title, std::string caption) {
  Panel panel = panel_with(std::move(id), std::move(title), std::move(caption), 1);
  Plot& plot = panel.plots.emplace_back();
  plot.x = linear_axis("east", "m");
  plot.y = linear_axis("north", "m");
  plot.equal_aspect = true;
  plot.height_px = kPlanHeight;
  return panel;
}

Panel xy_panel(std::string id, std::string title, Axis x, Axis y, std::string caption) {
  Panel panel = panel_with(std::move(id), std::move(title), std::move(caption), 1);
  Plot& plot = panel.plots.emplace_back();
  plot.x = std::move(x);
  plot.y = std::move(y);
  return panel;
}

Panel grid_panel(std::string id, std::string title, int columns, std::string caption) {
  if (columns < 1) throw std::invalid_argument(fmt::format("grid_panel: columns = {}, expected >= 1", columns));
  return panel_with(std::move(id), std::move(title), std::move(caption), columns);
}

Plot& add_cell(Panel& grid, std::string title, std::string x_label, std::string y_label, std::string unit) {
  const std::size_t row = grid.plots.size() / static_cast<std::size_t>(grid.columns);
  Plot& plot = grid.plots.emplace_back();
  plot.title = std::move(title);
  plot.x = linear_axis(std::move(x_label), "s");
  plot.y = linear_axis(std::move(y_label), std::move(unit));
  plot.link = fmt::format("{}-{}", grid.id, row);
  plot.height_px = kCellHeight;
  return plot;
}

Line& add_line(Plot& plot, std::string label, Series series, Tone tone) {
  Line& line = plot.lines.emplace_back();
  line.label = std::move(label);
  line.series = std::move(series);
  line.tone = tone;
  return line;
}

Points& add_points(Plot& plot, std::string label, Series series, Tone tone) {
  Points& points = plot.points.emplace_back();
  points.label = std::move(label);
  points.series = std::move(series);
  points.tone = tone;
  return points;
}

Bars& add_histogram(Plot& plot, std::string label, std::vector<double> values, int bins, Tone tone) {
  if (bins < 1) throw std::invalid_argument(fmt::format("add_histogram: bins = {}, expected >= 1", bins));
  Bars& bars = plot.bars.emplace_back();
  bars.label = std::move(label);
  bars.tone = tone;
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }), values.end());
  if (values.empty()) return bars;
  const auto quantile = [&](double p) {
    const auto rank = static_cast<std::ptrdiff_t>(std::lround(p * static_cast<double>(values.size() - 1)));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
  };
  double low = quantile(0.0005);
  double high = quantile(0.9995);
  if (!(high > low)) {  // all equal: one bar with a width that can be drawn
    const double half = std::max(1e-9, 0.5 * std::abs(low));
    low -= half;
    high += half;
  }
  const double width = (high - low) / bins;
  for (int i = 0; i <= bins; ++i) bars.edges.push_back(low + width * i);
  bars.heights.assign(static_cast<std::size_t>(bins), 0.0);
  for (const double value : values) {
    const double bin = std::clamp(std::floor((value - low) / width), 0.0, static_cast<double>(bins - 1));
    bars.heights[static_cast<std::size_t>(bin)] += 1.0;
  }
  return bars;
}

void add_bound(Plot& plot, double value, std::string label) {
  plot.bounds.push_back({value, std::move(label), Tone::kMuted});
}

void shade(Panel& panel, std::span<const Interval> intervals) {
  for (Plot& plot : panel.plots) {
    if (plot.x.scale == Axis::Scale::kTime) plot.intervals.insert(plot.intervals.end(), intervals.begin(), intervals.end());
  }
}

Tone tone_of(record::FixQuality quality) {
  switch (quality) {
    case record::FixQuality::kFixed:
      return Tone::kFixed;
    case record::FixQuality::kFloat:
      return Tone::kFloat;
    case record::FixQuality::kSbas:
      return Tone::kSbas;
    case record::FixQuality::kDgps:
      return Tone::kDgps;
    case record::FixQuality::kSingle:
      return Tone::kSingle;
    case record::FixQuality::kPpp:
      return Tone::kPpp;
    case record::FixQuality::kUnknown:
      break;
  }
  return Tone::kUnknown;
}

std::string name_of(record::FixQuality quality) {
  switch (quality) {
    case record::FixQuality::kFixed:
      return "fixed";
    case record::FixQuality::kFloat:
      return "float";
    case record::FixQuality::kSbas:
      return "SBAS";
    case record::FixQuality::kDgps:
      return "DGPS";
    case record::FixQuality::kSingle:
      return "single";
    case record::FixQuality::kPpp:
      return "PPP";
    case record::FixQuality::kUnknown:
      break;
  }
  return "not stated";
}

}  // namespace coast::report
