// Output files and messages of `coast fleet`.

#include <fmt/format.h>

#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/page_parts.hpp"
#include "common/results.hpp"
#include "fleet/result.hpp"

namespace coast::jobs {

namespace {

/// A field of a CSV file; quoted where it must be.
std::string field(const std::string& text) {
  return text.find_first_of(",;\t") == std::string::npos ? text : "\"" + text + "\"";
}

std::string optional_text(const std::optional<fleet::Slope>& slope) {
  return slope ? fmt::format("{:.9g},{:.9g},{}", slope->value, slope->sd, slope->supported ? 1 : 0) : ",,";
}

std::string pooled_csv(const FleetResult& result) {
  std::string text =
      "quantity,axis,unit_of_value,unit,missions,left_out,value,sd,low_95,high_95,tau,tau_low_95,tau_high_95,shrunk,shrunk_sd,"
      "per_kelvin,per_kelvin_sd,per_kelvin_supported,per_year,per_year_sd,per_year_supported\n";
  for (std::size_t p = 0; p < result.pooled.size(); ++p) {
    const fleet::Panel& panel = result.estimates.fleet.panels[p];
    for (std::size_t u = 0; u < panel.series.size(); ++u) {
      const fleet::PooledUnit& unit = result.pooled[p].units[u];
      if (unit.missions == 0) continue;
      text += fmt::format("{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},", field(panel.quantity), field(panel.axis),
                          field(panel.unit_of_value), field(panel.series[u].unit), unit.missions, unit.left_out, unit.value,
                          unit.sd, unit.value_95.first, unit.value_95.second, unit.tau);
      text += unit.tau_95 ? fmt::format("{:.9g},{:.9g}", unit.tau_95->first, unit.tau_95->second) : ",";
      text += fmt::format(",{:.9g},{:.9g},{},{}\n", unit.shrunk, unit.shrunk_sd, optional_text(unit.temperature),
                          optional_text(unit.drift));
    }
  }
  return text;
}

std::string changes_csv(const FleetResult& result) {
  std::string text =
      "kind,quantity,axis,unit_of_value,unit,shared,date,date_low_95,date_high_95,level,size,size_sd,statistic,p\n";
  for (const FleetFinding& finding : result.findings)
    for (const FleetFinding::Part& part : finding.parts) {
      const fleet::Panel& panel = result.estimates.fleet.panels[part.panel];
      const fleet::Change& change = result.changes.panels[part.panel].changes[part.change];
      const bool dated = change.kind == fleet::ChangeKind::kStep;
      const auto day = [&](double t) { return dated ? day_of(result.estimates, t) : std::string(); };
      for (std::size_t i = 0; i < change.units.size(); ++i)
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{:.9g},{:.9g},{:.6g},{:.4g}\n", name_of(change.kind),
                            field(panel.quantity), field(panel.axis), field(panel.unit_of_value),
                            field(panel.series[change.units[i]].unit), change.units.size() > 1 ? 1 : 0, day(change.t),
                            day(change.t_95.first), day(change.t_95.second), field(change.level), change.size[i],
                            change.size_sd[i], change.statistic, change.p);
    }
  return text;
}

std::string missions_csv(const FleetResult& result) {
  std::string text = "mission,unit,day,quantity,axis,unit_of_value,value,expected,standardised,p,departs\n";
  for (const fleet::Departure& d : result.changes.departures) {
    const fleet::Panel& panel = result.estimates.fleet.panels[d.panel];
    const fleet::Estimate& e = estimate_of(result.estimates.fleet, d);
    text +=
        fmt::format("{},{},{},{},{},{},{:.9g},{:.9g},{:.5g},{:.4g},{}\n", field(e.mission), field(panel.series[d.series].unit),
                    day_of(result.estimates, e.t), field(panel.quantity), field(panel.axis), field(panel.unit_of_value),
                    e.value, d.expected, d.standardised, d.p, d.outlier ? 1 : 0);
  }
  return text;
}

}  // namespace

std::vector<std::string> files_of(const FleetConfig&) {
  return {"pooled.csv", "changes.csv", "missions.csv", "fleet.json", "report.json", "report.html"};
}

void write(const FleetConfig& config, const FleetResult& result, const std::filesystem::path& folder) {
  const report::Page page = fleet_page(config, result);
  io::begin_results(folder / "fleet.json");
  io::write_text(folder / "pooled.csv", pooled_csv(result));
  io::write_text(folder / "changes.csv", changes_csv(result));
  io::write_text(folder / "missions.csv", missions_csv(result));
  write_page(page, folder);
  io::write_text(folder / "fleet.json", fleet_json(config, result));
}

std::string told(const FleetConfig& config, const FleetResult& result, const std::filesystem::path& folder) {
  const FleetEstimates& estimates = result.estimates;
  std::string text = fmt::format("{} missions of {} units, {} figures; false alarms: {} % of such fleets without changes\n",
                                 estimates.missions, estimates.units, estimates.fleet.panels.size(),
                                 number(100.0 * config.options.false_alarm_probability));
  for (const FleetFinding& finding : result.findings) text += finding.sentence + "\n";
  for (const fleet::Departure& d : result.changes.departures)
    if (d.outlier) text += departure_sentence(estimates, d) + "\n";
  const bool any =
      !result.findings.empty() || (!result.changes.departures.empty() && result.changes.departures.front().outlier);
  if (!any) text += "Nothing changed, and no mission departs.\n";
  return text + fmt::format("report: {}\n", (folder / "report.html").string());
}

}  // namespace coast::jobs
