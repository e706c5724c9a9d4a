// fleet.json: what many missions say together. SI; dates are days of GPS time.

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/error_json.hpp"
#include "fleet/result.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;

Json pair_json(const std::pair<double, double>& p) {
  return {p.first, p.second};
}

Json slope_json(const fleet::Slope& slope) {
  return {
      {"value", slope.value}, {"sd", slope.sd}, {"likelihood_ratio", slope.likelihood_ratio}, {"supported", slope.supported}};
}

Json unit_json(const std::string& name, const fleet::PooledUnit& unit) {
  Json j = {{"unit", name}, {"missions", unit.missions}, {"left_out", unit.left_out}};
  if (unit.missions == 0) return j;
  j["value"] = unit.value;
  j["sd"] = unit.sd;
  j["value_95"] = pair_json(unit.value_95);
  j["tau"] = unit.tau;
  if (unit.tau_95) j["tau_95"] = pair_json(*unit.tau_95);
  j["shrunk"] = unit.shrunk;
  j["shrunk_sd"] = unit.shrunk_sd;
  if (unit.temperature) {
    j["per_kelvin"] = slope_json(*unit.temperature);
    j["mean_temperature_degC"] = unit.mean_temperature;
  }
  if (unit.drift) j["per_year"] = slope_json(*unit.drift);
  return j;
}

Json figure_json(const fleet::Panel& panel, const fleet::PanelChanges& changes, const fleet::PooledPanel& pooled) {
  Json j = {{"quantity", panel.quantity}, {"axis", panel.axis}, {"unit_of_value", panel.unit_of_value}};
  j["scatter"] = {{"tau", changes.scatter.tau}};
  if (changes.scatter.walk > 0.0) {
    j["scatter"]["walk_per_sqrt_year"] = changes.scatter.walk;
    j["scatter"]["walk_log_likelihood_gain"] = changes.walk_gain;
  }
  if (pooled.mean)
    j["fleet"] = {{"value", pooled.mean->value},
                  {"sd", pooled.mean->sd},
                  {"value_95", pair_json(pooled.mean->value_95)},
                  {"between_units", pooled.mean->between},
                  {"between_units_95", pair_json(pooled.mean->between_95)}};
  j["units"] = Json::array();
  for (std::size_t u = 0; u < panel.series.size(); ++u) j["units"].push_back(unit_json(panel.series[u].unit, pooled.units[u]));
  return j;
}

Json finding_json(const FleetResult& result, const FleetFinding& finding) {
  Json j = {{"sentence", finding.sentence}, {"p", finding.p}, {"units", finding.units}};
  j["parts"] = Json::array();
  for (const FleetFinding::Part& part : finding.parts) {
    const fleet::Panel& panel = result.estimates.fleet.panels[part.panel];
    const fleet::Change& change = result.changes.panels[part.panel].changes[part.change];
    Json one = {{"kind", name_of(change.kind)}, {"quantity", panel.quantity}, {"axis", panel.axis}};
    if (change.kind == fleet::ChangeKind::kStep) {
      one["date"] = day_of(result.estimates, change.t);
      one["date_95"] = {day_of(result.estimates, change.t_95.first), day_of(result.estimates, change.t_95.second)};
    }
    if (change.kind == fleet::ChangeKind::kGroupLevel)
      one["group"] = {{"column", result.estimates.fleet.factors[change.factor]}, {"level", change.level}};
    one["size"] = change.common_size;
    one["size_sd"] = change.common_sd;
    one["statistic"] = change.statistic;
    one["p"] = change.p;
    one["units"] = Json::array();
    for (std::size_t i = 0; i < change.units.size(); ++i)
      one["units"].push_back(
          {{"unit", panel.series[change.units[i]].unit}, {"size", change.size[i]}, {"size_sd", change.size_sd[i]}});
    j["parts"].push_back(std::move(one));
  }
  return j;
}

Json departure_json(const FleetResult& result, const fleet::Departure& d) {
  const fleet::Panel& panel = result.estimates.fleet.panels[d.panel];
  const fleet::Estimate& e = estimate_of(result.estimates.fleet, d);
  return {{"sentence", departure_sentence(result.estimates, d)},
          {"mission", e.mission},
          {"unit", panel.series[d.series].unit},
          {"day", day_of(result.estimates, e.t)},
          {"quantity", panel.quantity},
          {"axis", panel.axis},
          {"value", e.value},
          {"expected", d.expected},
          {"standardised", d.standardised},
          {"p", d.p}};
}

}  // namespace

std::string fleet_json(const FleetConfig& config, const FleetResult& result) {
  const FleetEstimates& estimates = result.estimates;
  Json j = {{"schema", "coast.fleet_result/1"},
            {"missions", estimates.missions},
            {"units", estimates.units},
            {"first_day", day_of(estimates, 0.0)},
            {"false_alarm_probability", config.options.false_alarm_probability},
            {"threshold", result.changes.threshold}};
  if (std::isfinite(result.changes.tails_nu)) j["tails_degrees_of_freedom"] = result.changes.tails_nu;
  j["events"] = events_json(estimates.events);
  j["findings"] = Json::array();
  for (const FleetFinding& finding : result.findings) j["findings"].push_back(finding_json(result, finding));
  j["departures"] = Json::array();
  for (const fleet::Departure& d : result.changes.departures)
    if (d.outlier) j["departures"].push_back(departure_json(result, d));
  j["figures"] = Json::array();
  for (std::size_t p = 0; p < estimates.fleet.panels.size(); ++p)
    j["figures"].push_back(figure_json(estimates.fleet.panels[p], result.changes.panels[p], result.pooled[p]));
  j["files"] = {{"pooled", "pooled.csv"}, {"changes", "changes.csv"}, {"missions", "missions.csv"}, {"report", "report.html"}};
  return j.dump(1) + "\n";
}

}  // namespace coast::jobs
