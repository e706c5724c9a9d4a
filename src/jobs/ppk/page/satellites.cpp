// Section: satellites, their places in the sky, and times.

#include <cmath>
#include <map>

#include "coast/geo/units.hpp"
#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"
#include "ppk/page/page.hpp"

namespace coast::jobs {

namespace {

using carrier::PpkEpoch;
using carrier::SignalResidual;
using Use = SignalResidual::Use;

report::Panel sky(const PpkResult& result) {
  report::Panel panel = report::xy_panel("sky", "Sky", {"east", "deg", report::Axis::Scale::kLinear, {}, {}},
                                         {"north", "deg", report::Axis::Scale::kLinear, {}, {}},
                                         "Where the satellites were, seen from the antenna: the zenith in the middle, the "
                                         "horizon outside. A side without satellites costs accuracy in that direction.");
  report::Plot& plot = panel.plot();
  plot.sky = true;
  plot.height_px = 520;
  std::map<record::SatelliteSystem, report::Series> tracks;
  std::map<record::Satellite, Eigen::Vector2d> last;
  const std::size_t step = 1 + result.solution.epochs.size() / 200;
  for (std::size_t i = 0; i < result.solution.epochs.size(); i += step)
    for (const SignalResidual& r : result.solution.epochs[i].residuals) {
      const double zenith = 90.0 - r.direction.elevation / geo::kDegree;
      const Eigen::Vector2d at(zenith * std::sin(r.direction.azimuth), zenith * std::cos(r.direction.azimuth));
      report::Series& track = tracks[r.satellite.system];
      track.x.push_back(at.x());
      track.y.push_back(at.y());
      last[r.satellite] = at;
    }
  for (auto& [system, track] : tracks) report::add_points(plot, std::string(record::name_of(system)), std::move(track));
  for (const auto& [satellite, at] : last) plot.marks.push_back({at.x(), at.y(), to_string(satellite)});
  return panel;
}

/// One row per satellite and band: times with an integer, with a float ambiguity, excluded.
report::Panel timeline(const PpkResult& result) {
  std::map<std::pair<record::Satellite, char>, double> rows;
  for (const PpkEpoch& epoch : result.solution.epochs)
    for (const SignalResidual& r : epoch.residuals)
      if (r.phase) rows[{r.satellite, r.band}] = 0.0;
  report::Panel panel = report::time_panel("timeline", "Phases", "", "Green integer, amber float, red left out.");
  report::Plot& plot = panel.plot();
  double row = 0.0;
  for (auto& [signal, at] : rows) {
    at = row++;
    plot.y.ticks.push_back({at, to_string(signal.first) + " " + signal.second});
  }
  plot.y.label = "satellite, band";
  plot.height_px = std::max(200, static_cast<int>(16 * rows.size()));
  for (const auto& [use, label, tone] :
       {std::tuple(Use::kFixed, "integer", report::Tone::kFixed), std::tuple(Use::kFloat, "float", report::Tone::kFloat),
        std::tuple(Use::kLeftOut, "left out", report::Tone::kBad)}) {
    report::Series points;
    const std::size_t step = 1 + result.solution.epochs.size() / 1500;  // as wide as a screen
    for (std::size_t i = 0; i < result.solution.epochs.size(); ++i)
      for (const SignalResidual& r : result.solution.epochs[i].residuals) {
        if (!r.phase || r.use != use || (use != Use::kLeftOut && i % step != 0)) continue;
        points.x.push_back(seconds(result, result.solution.epochs[i]));
        points.y.push_back(rows.at({r.satellite, r.band}));
      }
    if (!points.x.empty()) report::add_points(plot, label, std::move(points), tone);
  }
  return panel;
}

}  // namespace

report::Section ppk_satellite_section(const PpkResult& result) {
  report::Section section;
  section.id = "sky-section";
  section.title = "Satellites";
  section.panels = {sky(result), timeline(result)};
  return section;
}

}  // namespace coast::jobs
