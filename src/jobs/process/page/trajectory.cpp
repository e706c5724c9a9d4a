// Section: plan view with GNSS quality and outages, height and speed.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "coast/geo/units.hpp"
#include "process/page/curves.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

/// Fixes of the antenna in the plan, by quality; withheld ones separately.
void add_fixes(const ProcessPage& page, report::Plot& plot) {
  const geo::LocalFrame& local = page.result.curves->curves().local;
  const auto withheld = [&](geo::GpsTime t) {
    return std::ranges::any_of(page.result.outages, [&](const auto& o) { return o.outage.span().contains(t); });
  };
  std::map<record::FixQuality, report::Decimator> by_quality;
  report::Decimator hidden;
  bool any_hidden = false;
  for (const record::GnssFix& fix : page.result.fixes) {
    if (fix.t < page.result.start || fix.t > page.result.end) continue;
    const Eigen::Vector3d at = local.to_ned(fix.r_ea_e);
    const double t = seconds_since_start(page, fix.t);
    any_hidden = any_hidden || withheld(fix.t);
    (withheld(fix.t) ? hidden : by_quality[fix.quality]).add_track(t, at.y(), at.x());
  }
  for (const auto& [quality, fixes] : by_quality)
    report::add_points(plot, "GNSS " + report::name_of(quality), fixes.finish(), report::tone_of(quality)).radius_px = 2.2;
  if (any_hidden) report::add_points(plot, "GNSS withheld", hidden.finish(), report::Tone::kMuted).radius_px = 2.2;
}

/// The stretches without GNSS as broad lines under the track, each with its number.
void add_outages(const ProcessPage& page, const report::Series& track, report::Plot& plot) {
  std::size_t index = 0;
  for (const report::Interval& interval : outage_intervals(page)) {
    report::Series stretch;
    for (std::size_t i = 0; i < track.x.size(); ++i) {
      if (track.t[i] < interval.from || track.t[i] > interval.to) continue;
      stretch.x.push_back(track.x[i]);
      stretch.y.push_back(track.y[i]);
      stretch.t.push_back(track.t[i]);
    }
    ++index;
    if (stretch.x.size() < 2) continue;
    const auto half = std::ranges::lower_bound(stretch.t, 0.5 * (interval.from + interval.to));
    const auto middle = std::min(static_cast<std::size_t>(half - stretch.t.begin()), stretch.x.size() - 1);
    plot.marks.push_back({stretch.x[middle], stretch.y[middle], fmt::format("{}", index)});
    report::add_line(plot, "outages", std::move(stretch), report::Tone::kBad).width_px = 9.0;
  }
}

/// Start and end, as one label if the track is closed.
void add_ends(const report::Series& track, report::Plot& plot) {
  if (track.x.empty()) return;
  const auto [west, east] = std::ranges::minmax(track.x);
  const auto [south, north] = std::ranges::minmax(track.y);
  const double gap = std::hypot(track.x.back() - track.x.front(), track.y.back() - track.y.front());
  const bool closed = gap < 0.05 * std::hypot(east - west, north - south);
  plot.marks.push_back({track.x.front(), track.y.front(), closed ? "start, end" : "start"});
  if (!closed) plot.marks.push_back({track.x.back(), track.y.back(), "end"});
}

/// Coordinates on the page are of single precision: less a round number they keep their millimetres.
double round_part(double coordinate) {
  constexpr double kRound = 1e4;
  return kRound * std::floor(coordinate / kRound);
}

/// East and north of the local frame to the coordinates of the projection, whose lines then are those of the plot.
void project_plan(const ProcessPage& page, report::Panel& panel) {
  const io::Projection& projection = *page.result.projection;
  const ProjectedStart& start = *page.result.projected_start;
  const double east = round_part(start.place.easting), north = round_part(start.place.northing);
  const geo::LocalFrame& local = page.result.curves->curves().local;
  const auto move = [&](double& x, double& y) {
    const io::GridPosition p = projection.at(local.to_ecef({y, x, 0.0}), page.result.start);
    x = p.easting - east;
    y = p.northing - north;
  };
  report::Plot& plot = panel.plot();
  const auto move_series = [&](report::Series& series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) move(series.x[i], series.y[i]);
  };
  for (report::Line& line : plot.lines) move_series(line.series);
  for (report::Points& points : plot.points) move_series(points.series);
  for (report::Mark& mark : plot.marks) move(mark.x, mark.y);
  const auto name_axis = [](const std::string& column, double less, report::Axis& axis) {
    const std::size_t unit = column.find('_');
    axis.label = fmt::format("{} less {:.0f}", column.substr(0, unit), less);
    axis.unit = column.substr(unit + 1);
  };
  name_axis(projection.columns().easting, east, plot.x);
  name_axis(projection.columns().northing, north, plot.y);
  panel.caption += fmt::format(
      " Lines are those of {}; grid north is up, {:+.4f} deg from true north at the start (convergence), where a metre on the "
      "ground is {:.6f} m on the grid (combined scale factor).",
      projection.name(), start.convergence / geo::kDegree, start.scale.combined);
}

report::Panel plan(const ProcessPage& page) {
  report::Panel panel = report::plan_panel(
      "plan", "Plan view",
      "The track runs through the fixes, displaced by the lever arm; fixed (green) nearly everywhere is good.");
  report::Plot& plot = panel.plot();
  const report::Series track = page.result.curves->curves().track.finish();
  add_outages(page, track, plot);
  add_fixes(page, plot);
  add_ends(track, plot);
  report::add_line(plot, delivered(page), track, delivered_tone(page)).width_px = 1.6;
  // A plan with axes to the south and west would be turned.
  if (const auto& projection = page.result.projection; projection && projection->columns().northing.starts_with("northing"))
    project_plan(page, panel);
  return panel;
}

report::Panel height(const ProcessPage& page) {
  const io::PositionOptions& position = page.config.gnss.position;
  const bool msl = position.above_mean_sea_level && !position.geoid_height;
  report::Panel panel =
      report::time_panel("height", "Height", "m",
                         fmt::format("{}; continuous through outages, no steps where GNSS returns.",
                                     msl ? "Above mean sea level, as the GNSS file has it" : "Ellipsoidal height"));
  report::Plot& plot = panel.plot();
  plot.y.label = "height";
  plot.height_px = 180;
  report::Decimator fixes({8000});
  for (const record::GnssFix& fix : page.result.fixes)
    if (fix.t >= page.result.start && fix.t <= page.result.end)
      fixes.add(seconds_since_start(page, fix.t), geo::geodetic_from_ecef(fix.r_ea_e).height);
  report::add_points(plot, "GNSS antenna", fixes.finish(), report::Tone::kFixed);
  report::add_line(plot, delivered(page), page.result.curves->curves().height.finish(), delivered_tone(page));
  report::shade(panel, outage_intervals(page));
  show_bulk(panel);
  return panel;
}

report::Panel speed(const ProcessPage& page) {
  report::Panel panel =
      report::time_panel("speed", "Speed", "m/s", "Horizontal; the profile of the vehicle, zero where it stood.");
  panel.plot().y.label = "speed";
  panel.plot().height_px = 180;
  report::add_line(panel.plot(), delivered(page), page.result.curves->curves().speed.finish(), delivered_tone(page));
  report::shade(panel, outage_intervals(page));
  return panel;
}

}  // namespace

report::Section trajectory_section(const ProcessPage& page) {
  report::Section section;
  section.id = "trajectory";
  section.title = "Trajectory";
  const report::Series distance = page.result.curves->curves().distance.finish();
  if (!distance.y.empty())
    section.lead =
        fmt::format("{} m travelled in {:.1f} s.", number(distance.y.back(), 4), page.result.end - page.result.start);
  section.panels = {plan(page), height(page), speed(page)};
  return section;
}

}  // namespace coast::jobs
