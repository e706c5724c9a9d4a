#pragma once
// One simulated recording with outages, processed as `coast process` does it. Private to the room.

#include "coast/simulate/scenario.hpp"
#include "coast/study/ensemble.hpp"

namespace coast::study {

/// Prepared, filtered once, and every outage by itself.
/// @param recordings     body axes  @param truth  of the scenario
/// @param refine_before  the start is refined with fixes before it alone: no later than the first outage of the study
/// @throws InputError  that is before the filter begins
[[nodiscard]] std::vector<OutageResult> solve_outages(const simulate::Scenario& scenario, const record::Trajectory& truth,
                                                      simulate::ErrorFreeMission::Recordings recordings,
                                                      const NamedModel& model, geo::GpsTime refine_before,
                                                      const std::vector<Outage>& outages);

}  // namespace coast::study
