#pragma once
// The usual panels in a line or two each:
//
//     Panel p = stacked_time_panel("velocity", "Velocity", {"N", "E", "D"}, "m/s", "The band is one sigma.");
//     for (int i = 0; i < 3; ++i) add_line(p.plots[i], "smoothed", velocity[i].finish(), Tone::kSmoothed);
//     shade(p, outages);

#include <span>
#include <string>
#include <vector>

#include "coast/report/page.hpp"

namespace coast::record {
enum class FixQuality;
}

namespace coast::report {

/// One plot over seconds since Page::start.
[[nodiscard]] Panel time_panel(std::string id, std::string title, std::string unit, std::string caption = {});
/// One plot per component, stacked over the same time axis; each labelled with its component and the unit.
[[nodiscard]] Panel stacked_time_panel(std::string id, std::string title, const std::vector<std::string>& components,
                                       const std::string& unit, std::string caption = {});
/// East and north in metres at equal scale.
[[nodiscard]] Panel plan_panel(std::string id, std::string title, std::string caption = {});
[[nodiscard]] Panel xy_panel(std::string id, std::string title, Axis x, Axis y, std::string caption = {});
/// A grid of small plots, filled row by row with add_cell.
[[nodiscard]] Panel grid_panel(std::string id, std::string title, int columns, std::string caption = {});
/// Adds a plot over x (seconds) to a grid; the cells of one row zoom together. @return  valid until the next cell is added
Plot& add_cell(Panel& grid, std::string title, std::string x_label, std::string y_label, std::string unit);

Line& add_line(Plot& plot, std::string label, Series series, Tone tone = Tone::kAuto);
Points& add_points(Plot& plot, std::string label, Series series, Tone tone = Tone::kAuto);
/// Counts of `values` in equal bins from the 0.05 % to the 99.95 % quantile; values outside are counted in the outermost bins.
Bars& add_histogram(Plot& plot, std::string label, std::vector<double> values, int bins, Tone tone = Tone::kAuto);
void add_bound(Plot& plot, double value, std::string label = {});

/// Shades the intervals in every plot of the panel that has a time axis.
void shade(Panel& panel, std::span<const Interval> intervals);

/// Colour and name of a GNSS quality: fixed green, float amber, single red.
[[nodiscard]] Tone tone_of(record::FixQuality quality);
[[nodiscard]] std::string name_of(record::FixQuality quality);

}  // namespace coast::report
