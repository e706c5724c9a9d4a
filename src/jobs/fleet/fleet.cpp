#include "coast/jobs/fleet.hpp"

#include <utility>

#include "common/tell.hpp"
#include "fleet/result.hpp"

namespace coast::jobs {

namespace {

std::vector<std::vector<std::vector<bool>>> outliers_of(const FleetResult& result) {
  std::vector<std::vector<std::vector<bool>>> left_out;
  for (const fleet::Panel& panel : result.estimates.fleet.panels) {
    auto& of_panel = left_out.emplace_back();
    for (const fleet::Series& series : panel.series) of_panel.emplace_back(series.estimates.size(), false);
  }
  for (const fleet::Departure& d : result.changes.departures)
    if (d.outlier) left_out[d.panel][d.series][d.index] = true;
  return left_out;
}

}  // namespace

const fleet::Estimate& estimate_of(const fleet::Fleet& fleet, const fleet::Departure& d) {
  return fleet.panels[d.panel].series[d.series].estimates[d.index];
}

FleetResult fleet_statistics(const FleetConfig& config, FleetEstimates estimates, const Progress& progress) {
  FleetResult result;
  result.estimates = std::move(estimates);
  tell_warnings(result.estimates.events, progress);
  result.changes = fleet::find_changes(result.estimates.fleet, config.options,
                                       [&](double share) { progress("looking for changes", share); });
  const auto left_out = outliers_of(result);
  for (std::size_t p = 0; p < left_out.size(); ++p)
    result.pooled.push_back(fleet::pool(result.estimates.fleet.panels[p], result.changes.panels[p], left_out[p]));
  result.findings = fleet_findings(result.estimates, result.changes);
  return result;
}

FleetResult fleet_statistics(const FleetConfig& config, const Progress& progress) {
  progress("reading", 0.0);
  return fleet_statistics(config, read_estimates(config), progress);
}

}  // namespace coast::jobs
