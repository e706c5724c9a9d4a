#pragma once
// One simulated recording with outages, processed as by `coast process`. Private to the room.

#include "coast/simulate/scenario.hpp"
#include "coast/study/ensemble.hpp"

namespace coast::study {

/// Prepared, filtered once, and every outage separately.
/// @param recordings     body axes  @param truth  of the scenario
/// @param refine_before  the start is refined only with fixes before it: no later than the first outage of the study
/// @throws InputError  it is before the start of the filter
[[nodiscard]] std::vector<OutageResult> solve_outages(const simulate::Scenario& scenario, const record::Trajectory& truth,
                                                      simulate::ErrorFreeMission::Recordings recordings,
                                                      const NamedModel& model, geo::GpsTime refine_before,
                                                      const std::vector<Outage>& outages);

}  // namespace coast::study
