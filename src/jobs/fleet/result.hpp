#pragma once
// Results of a fleet in words, as JSON and as a page.

#include <string>

#include "coast/jobs/fleet.hpp"
#include "coast/report/page.hpp"

namespace coast::jobs {

/// Changes of one time told together.
[[nodiscard]] std::vector<FleetFinding> fleet_findings(const FleetEstimates& estimates, const fleet::FleetChanges& changes);
/// "Mission m12 of unit 3 departs in lever_arm y: .."
[[nodiscard]] std::string departure_sentence(const FleetEstimates& estimates, const fleet::Departure& departure);
/// "lever_arm x"
[[nodiscard]] std::string figure_name(const fleet::Panel& panel);
/// "2025-07-08", the day of an instant in years since the first mission.
[[nodiscard]] std::string day_of(const FleetEstimates& estimates, double years);
[[nodiscard]] const char* name_of(fleet::ChangeKind kind);
[[nodiscard]] const fleet::Estimate& estimate_of(const fleet::Fleet& fleet, const fleet::Departure& departure);

[[nodiscard]] std::string fleet_json(const FleetConfig& config, const FleetResult& result);
[[nodiscard]] report::Page fleet_page(const FleetConfig& config, const FleetResult& result);

}  // namespace coast::jobs
