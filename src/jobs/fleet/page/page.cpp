// The page of `coast fleet`: what changed, which missions depart, values of units and fleet, charts over time.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"
#include "fleet/result.hpp"

namespace coast::jobs {

namespace {

using report::Tone;
using report::Verdict;

constexpr std::size_t kRankedRows = 30;

report::Tile tile(std::string label, std::string value, std::string unit, std::string explanation, Verdict verdict,
                  std::string section) {
  report::Tile t;
  t.label = std::move(label);
  t.value = std::move(value);
  t.unit = std::move(unit);
  t.explanation = std::move(explanation);
  t.verdict = verdict;
  t.section = std::move(section);
  return t;
}

std::vector<report::Tile> tiles_of(const FleetConfig& config, const FleetResult& result) {
  const auto outliers = std::ranges::count(result.changes.departures, true, &fleet::Departure::outlier);
  return {
      tile("Changes", fmt::format("{}", result.findings.size()), "",
           "Steps, drifts, and what several units share; none is good.",
           result.findings.empty() ? Verdict::kGood : Verdict::kWarn, "changes"),
      tile("Estimates that depart", fmt::format("{}", outliers), fmt::format("of {}", result.changes.departures.size()),
           "Single estimates that their unit's other missions contradict; left out of what is pooled.",
           outliers == 0 ? Verdict::kGood : Verdict::kWarn, "departures"),
      tile("Units", fmt::format("{}", result.estimates.units), "", "Sensors of the fleet.", Verdict::kNone, "values"),
      tile("Missions", fmt::format("{}", result.estimates.missions), "", "Missions with estimates.", Verdict::kNone, "charts"),
      tile("False alarms", number(100.0 * config.options.false_alarm_probability), "%",
           "Of fleets like this without any change or departing mission, this share shows one at least.", Verdict::kNone,
           "changes")};
}

report::Section changes_section(const FleetResult& result) {
  report::Section section{"changes", "What changed, and when", "", {}, {}, {}};
  section.lead =
      result.findings.empty() ? "No unit changed." : "Each event is told once, with all figures and units that show it.";
  for (const FleetFinding& finding : result.findings)
    section.notes.push_back({report::Note::Kind::kWarning, "", finding.sentence});
  report::Table table{"change-table", "Changes", "p: share of fleets without changes that show anything as large.", {}, {}};
  table.columns = {{"kind", "", false},
                   {"figure", "", false},
                   {"units", "", false},
                   {"date", "", false},
                   {"from", "", false},
                   {"to", "", false},
                   {"size", ""},
                   {"+-", ""},
                   {"in", "", false},
                   {"statistic", ""},
                   {"p", ""}};
  for (const FleetFinding& finding : result.findings)
    for (const FleetFinding::Part& part : finding.parts) {
      const fleet::Panel& panel = result.estimates.fleet.panels[part.panel];
      const fleet::Change& change = result.changes.panels[part.panel].changes[part.change];
      std::vector<std::string> units;
      for (const std::size_t u : change.units) units.push_back(panel.series[u].unit);
      const bool dated = change.kind == fleet::ChangeKind::kStep;
      const auto day = [&](double t) { return dated ? day_of(result.estimates, t) : std::string(); };
      table.rows.push_back(
          cells({name_of(change.kind), figure_name(panel), joined(units, ", "), day(change.t), day(change.t_95.first),
                 day(change.t_95.second), number(change.common_size), number(change.common_sd, 2),
                 panel.unit_of_value + (change.kind == fleet::ChangeKind::kDrift ? "/year" : ""), decimals(change.statistic, 1),
                 number(change.p, 2)}));
    }
  if (!table.rows.empty()) section.tables.push_back(std::move(table));
  for (std::size_t p = 0; p < result.changes.panels.size(); ++p)
    if (const fleet::Scatter& scatter = result.changes.panels[p].scatter; scatter.walk > 0.0)
      section.notes.push_back({report::Note::Kind::kInfo, "Random walk",
                               fmt::format("{} of every unit walks by {} {} per square root of a year.",
                                           figure_name(result.estimates.fleet.panels[p]), number(scatter.walk),
                                           result.estimates.fleet.panels[p].unit_of_value)});
  return section;
}

report::Section departures_section(const FleetResult& result) {
  report::Section section{"departures", "Missions that depart", "", {}, {}, {}};
  section.lead =
      "Each estimate against what the other missions of its unit say, changes included. Most improbable first; what is "
      "marked departs by more than chance, all estimates considered.";
  report::Table table{"departure-table", "Ranked", "", {}, {}};
  table.columns = {{"", "", false}, {"mission", "", false}, {"unit", "", false}, {"day", "", false}, {"figure", "", false},
                   {"value", ""},   {"expected", ""},       {"in", "", false},   {"sigma", ""},      {"p", ""}};
  for (const fleet::Departure& d : result.changes.departures) {
    if (table.rows.size() >= kRankedRows && !d.outlier) break;
    const fleet::Panel& panel = result.estimates.fleet.panels[d.panel];
    const fleet::Estimate& e = estimate_of(result.estimates.fleet, d);
    auto row = cells({d.outlier ? "departs" : "", e.mission, panel.series[d.series].unit, day_of(result.estimates, e.t),
                      figure_name(panel), number(e.value, 4), number(d.expected, 4), panel.unit_of_value,
                      decimals(d.standardised, 2), fmt::format("{:.2g}", d.p)});
    if (d.outlier) row[0].verdict = Verdict::kBad;
    table.rows.push_back(std::move(row));
  }
  if (!table.rows.empty()) section.tables.push_back(std::move(table));
  return section;
}

report::Table value_table(const fleet::Panel& panel, const fleet::PanelChanges& changes, const fleet::PooledPanel& pooled,
                          std::size_t index) {
  report::Table table;
  table.id = fmt::format("values-{}", index);
  table.title = figure_name(panel);
  table.caption =
      fmt::format("Between missions a unit scatters by {} beyond the missions' sigmas.", number(changes.scatter.tau));
  if (pooled.mean)
    table.caption += fmt::format(" Fleet: {} +- {}, units differ by {} ({} to {}).", number(pooled.mean->value),
                                 number(pooled.mean->sd, 2), number(pooled.mean->between, 2),
                                 number(pooled.mean->between_95.first, 2), number(pooled.mean->between_95.second, 2));
  const std::string& unit = panel.unit_of_value;
  table.columns = {{"unit", "", false}, {"missions", ""},  {"value", unit},       {"+-", unit}, {"low 95 %", unit},
                   {"high 95 %", unit}, {"scatter", unit}, {"with others", unit}, {"+-", unit}, {"per kelvin", unit},
                   {"+-", unit},        {"", "", false},   {"per year", unit},    {"+-", unit}, {"", "", false}};
  for (std::size_t u = 0; u < panel.series.size(); ++u) {
    const fleet::PooledUnit& p = pooled.units[u];
    if (p.missions == 0) continue;
    std::vector<std::string> slopes;
    for (const auto* slope : {&p.temperature, &p.drift}) {
      slopes.push_back(*slope ? number((*slope)->value) : "");
      slopes.push_back(*slope ? number((*slope)->sd, 2) : "");
      slopes.emplace_back(*slope && (*slope)->supported ? "supported" : "");
    }
    table.rows.push_back(
        cells({panel.series[u].unit, fmt::format("{}", p.missions), number(p.value, 4), number(p.sd, 2),
               number(p.value_95.first, 4), number(p.value_95.second, 4), number(p.tau, 2), number(p.shrunk, 4),
               number(p.shrunk_sd, 2), slopes[0], slopes[1], slopes[2], slopes[3], slopes[4], slopes[5]}));
  }
  return table;
}

report::Section values_section(const FleetResult& result) {
  report::Section section{"values", "Values", "", {}, {}, {}};
  section.lead =
      "Of each unit after all steps, at its last mission and mean temperature; missions that depart are left out. Dependence "
      "on "
      "temperature and time are fitted together.";
  for (std::size_t p = 0; p < result.pooled.size(); ++p)
    section.tables.push_back(value_table(result.estimates.fleet.panels[p], result.changes.panels[p], result.pooled[p], p));
  return section;
}

double decimal_year(const FleetEstimates& estimates, double t) {
  constexpr double kYear = 365.25 * 86400.0;
  return 1980.0 + 5.0 / 365.25 + static_cast<double>(estimates.start.nanoseconds()) / 1e9 / kYear + t;
}

/// Values less the unit's own; units that changed as curves of what the model expects.
report::Plot chart(const FleetResult& result, std::size_t p) {
  const fleet::Panel& panel = result.estimates.fleet.panels[p];
  report::Plot plot;
  plot.x = {"date", "year", report::Axis::Scale::kLinear, {}, {}};
  plot.y = {figure_name(panel), panel.unit_of_value, report::Axis::Scale::kLinear, {}, {}};
  plot.link = "years";
  std::set<std::size_t> changed;
  for (const fleet::Change& change : result.changes.panels[p].changes) {
    changed.insert(change.units.begin(), change.units.end());
    if (change.kind == fleet::ChangeKind::kStep)
      plot.intervals.push_back({decimal_year(result.estimates, change.t_95.first),
                                decimal_year(result.estimates, change.t_95.second), "date of a step, 95 %", Tone::kWarn});
  }
  report::Series others;
  report::Series departing;
  for (std::size_t u = 0; u < panel.series.size(); ++u) {
    report::Series own;
    for (const fleet::Estimate& e : panel.series[u].estimates) {
      report::Series& series = changed.contains(u) ? own : others;
      series.x.push_back(decimal_year(result.estimates, e.t));
      series.y.push_back(e.value - result.pooled[p].units[u].value);
    }
    if (!changed.contains(u)) continue;
    report::add_points(plot, panel.series[u].unit, own).radius_px = 3.0;
    std::vector<std::pair<double, double>> expected;
    for (const fleet::Departure& d : result.changes.departures)
      if (d.panel == p && d.series == u)
        expected.emplace_back(decimal_year(result.estimates, panel.series[u].estimates[d.index].t),
                              d.expected - result.pooled[p].units[u].value);
    std::ranges::sort(expected);
    report::Series line;
    for (const auto& [x, y] : expected) line.x.push_back(x), line.y.push_back(y);
    if (!line.x.empty()) report::add_line(plot, panel.series[u].unit + ", expected", std::move(line));
  }
  if (!others.x.empty()) report::add_points(plot, "units without change", std::move(others), Tone::kMuted).radius_px = 2.0;
  for (const fleet::Departure& d : result.changes.departures) {
    if (!d.outlier || d.panel != p) continue;
    const fleet::Estimate& e = panel.series[d.series].estimates[d.index];
    departing.x.push_back(decimal_year(result.estimates, e.t));
    departing.y.push_back(e.value - result.pooled[p].units[d.series].value);
  }
  if (!departing.x.empty()) report::add_points(plot, "departs", std::move(departing), Tone::kBad).radius_px = 4.0;
  return plot;
}

report::Section charts_section(const FleetResult& result) {
  report::Section section{"charts", "Control charts", "", {}, {}, {}};
  section.lead =
      "Every mission's value less its unit's value at its last mission. Good: a band about zero without trend or step.";
  for (std::size_t p = 0; p < result.pooled.size(); ++p) {
    report::Panel panel;
    panel.id = fmt::format("chart-{}", p);
    panel.title = figure_name(result.estimates.fleet.panels[p]);
    panel.plots.push_back(chart(result, p));
    section.panels.push_back(std::move(panel));
  }
  return section;
}

}  // namespace

report::Page fleet_page(const FleetConfig& config, const FleetResult& result) {
  report::Page page;
  page.title = fmt::format("Fleet of {} units", result.estimates.units);
  page.subtitle = fmt::format("{}: {} missions from {}", config.file.filename().string(), result.estimates.missions,
                              day_of(result.estimates, 0.0));
  page.tiles = tiles_of(config, result);
  page.sections = {changes_section(result), departures_section(result), values_section(result), charts_section(result)};
  if (!result.estimates.events.empty()) page.sections.back().tables.push_back(event_table(result.estimates.events));
  page.footer = fmt::format("coast {}: fleet {}", COAST_VERSION, config.file.filename().string());
  return page;
}

}  // namespace coast::jobs
