#pragma once
// One simulated recording with one outage, processed as `coast process` does it. Private to the room.

#include "coast/simulate/scenario.hpp"
#include "coast/study/outage.hpp"

namespace coast::study {

/// The outage's fixes are withheld from the first step on: neither the refined start nor anything else has seen them. The
/// recording ends `kTail` after it.
/// @param recordings  body axes  @param truth  of the scenario
/// @throws InputError  the outage begins before the filter does
[[nodiscard]] OutageResult solve_outage(const simulate::Scenario& scenario, const record::Trajectory& truth,
                                        simulate::ErrorFreeMission::Recordings recordings, const noise::ImuErrorModel& model,
                                        const Outage& outage);

}  // namespace coast::study
