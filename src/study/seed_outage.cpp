#include "seed_outage.hpp"

#include <fmt/format.h>

#include "coast/ins/mounting.hpp"
#include "coast/record/error.hpp"

namespace coast::study {

namespace {

Setup setup_of(const simulate::Scenario& scenario, const NamedModel& model) {
  Setup setup;
  setup.C_s_b = ins::C_s_b(scenario.mounting);
  setup.lever_arm_b = scenario.gnss.lever_arm_b;
  setup.time_offset_s = scenario.gnss.time_offset;
  setup.model = model.model;
  setup.batch = model.batch;
  return setup;
}

}  // namespace

std::vector<OutageResult> solve_outages(const simulate::Scenario& scenario, const record::Trajectory& truth,
                                        simulate::ErrorFreeMission::Recordings recordings, const NamedModel& model,
                                        geo::GpsTime refine_before, const std::vector<Outage>& outages) {
  Setup setup = setup_of(scenario, model);
  setup.refine_before = refine_before;
  const PreparedMission mission(std::move(recordings.imu), std::move(recordings.gnss), std::move(setup), {});
  if (refine_before < mission.start().nav.t)
    throw InputError({"", 0, fmt::format("an outage {:.3f} s after the start of the scenario", refine_before - scenario.start),
                      fmt::format("one after the alignment, from {:.3f} s on", mission.start().nav.t - scenario.start), ""});
  const Truth against{truth};
  if (!model.batch) return run_outages(mission, gap_free_knots(mission, {}), against, outages);
  std::vector<OutageResult> results;
  for (const Outage& outage : outages) results.push_back(run_outage_whole(mission, against, outage));
  return results;
}

}  // namespace coast::study
