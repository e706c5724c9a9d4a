// Section: residuals of phases and codes.

#include <fmt/format.h>

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

/// Residuals of phases, mm, or codes, m, by band, as function of a quantity.
report::Panel over(const PpkResult& result, report::Panel panel, bool phase,
                   const std::function<double(const PpkEpoch&, const SignalResidual&)>& x) {
  std::map<char, report::Decimator> bands;
  report::Decimator left_out;
  bool any = false;
  for (const PpkEpoch& epoch : result.solution.epochs)
    for (const SignalResidual& r : epoch.residuals) {
      if (r.phase != phase) continue;
      const double y = (phase ? 1000.0 : 1.0) * r.residual;
      if (r.use == Use::kLeftOut) {
        left_out.add(x(epoch, r), y);
        any = true;
      } else {
        bands.try_emplace(r.band).first->second.add(x(epoch, r), y);
      }
    }
  for (const auto& [band, points] : bands)
    report::add_points(panel.plot(), fmt::format("band {}", band), points.finish()).radius_px = 1.2;
  if (any && !phase) report::add_points(panel.plot(), "left out", left_out.finish(), report::Tone::kBad);
  show_bulk(panel, kErrors);
  return panel;
}

report::Panel over_time(const PpkResult& result, bool phase) {
  report::Panel panel = report::time_panel(
      phase ? "phase-residuals" : "code-residuals", phase ? "Residuals of phases" : "Residuals of codes", phase ? "mm" : "m",
      phase ? "With the integers where they are fixed: millimetres, no trends." : "Decimetres; slow waves are multipath.");
  return over(result, std::move(panel), phase,
              [&](const PpkEpoch& epoch, const SignalResidual&) { return seconds(result, epoch); });
}

report::Panel over_elevation(const PpkResult& result, bool phase) {
  const report::Axis x{"elevation", "deg", report::Axis::Scale::kLinear, {}, std::nullopt};
  const report::Axis y{"residual", phase ? "mm" : "m", report::Axis::Scale::kLinear, {}, std::nullopt};
  report::Panel panel =
      report::xy_panel(phase ? "phase-elevation" : "code-elevation", phase ? "Phases over elevation" : "Codes over elevation",
                       x, y, "Wider towards the horizon; one satellite apart from the others has a slip or an obstacle.");
  return over(result, std::move(panel), phase,
              [](const PpkEpoch&, const SignalResidual& r) { return r.direction.elevation / geo::kDegree; });
}

struct OfSatellite {
  double phase_squares = 0.0, phases = 0.0, code_squares = 0.0, codes = 0.0, fixed = 0.0, left_out = 0.0;
};

report::Table by_satellite(const PpkResult& result) {
  std::map<record::Satellite, OfSatellite> all;
  for (const PpkEpoch& epoch : result.solution.epochs)
    for (const SignalResidual& r : epoch.residuals) {
      OfSatellite& of = all[r.satellite];
      if (r.use == Use::kLeftOut) {
        of.left_out += 1.0;
        continue;
      }
      (r.phase ? of.phase_squares : of.code_squares) += r.residual * r.residual;
      (r.phase ? of.phases : of.codes) += 1.0;
      if (r.use == Use::kFixed) of.fixed += 1.0;
    }
  report::Table table;
  table.id = "by-satellite";
  table.title = "By satellite";
  table.columns = {{"satellite", "", false}, {"phases", ""},        {"with integers", "%"},
                   {"rms of phases", "mm"},  {"rms of codes", "m"}, {"left out", ""}};
  for (const auto& [satellite, of] : all)
    table.rows.push_back(
        cells({to_string(satellite), fmt::format("{:.0f}", of.phases), of.phases > 0.0 ? percent(of.fixed / of.phases) : "",
               of.phases > 0.0 ? number(1000.0 * std::sqrt(of.phase_squares / of.phases)) : "",
               of.codes > 0.0 ? number(std::sqrt(of.code_squares / of.codes)) : "", fmt::format("{:.0f}", of.left_out)}));
  return table;
}

}  // namespace

report::Section ppk_residual_section(const PpkResult& result) {
  report::Section section;
  section.id = "residuals";
  section.title = "Residuals";
  section.lead = "Of every satellite against the mean of those that share a receiver's clock, after adjustment.";
  section.tables = {by_satellite(result)};
  section.panels = {over_time(result, true), over_elevation(result, true), over_time(result, false),
                    over_elevation(result, false)};
  return section;
}

}  // namespace coast::jobs
