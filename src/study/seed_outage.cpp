#include "seed_outage.hpp"

#include <fmt/format.h>

#include "coast/ins/mounting.hpp"
#include "coast/record/error.hpp"
#include "coast/study/ensemble.hpp"
#include "coast/study/mission.hpp"

namespace coast::study {

namespace {

Setup setup_of(const simulate::Scenario& scenario, const noise::ImuErrorModel& model) {
  Setup setup;
  setup.C_s_b = ins::C_s_b(scenario.mounting);
  setup.lever_arm_b = scenario.gnss.lever_arm_b;
  setup.time_offset_s = scenario.gnss.time_offset;
  setup.model = model;
  return setup;
}

}  // namespace

OutageResult solve_outage(const simulate::Scenario& scenario, const record::Trajectory& truth,
                          simulate::ErrorFreeMission::Recordings recordings, const noise::ImuErrorModel& model,
                          const Outage& outage) {
  Setup setup = setup_of(scenario, model);
  setup.filter.withheld.push_back(outage.span());
  const geo::GpsTime end = outage.span().to + kTail;
  std::erase_if(recordings.imu.samples, [&](const record::ImuSample& s) { return s.t > end; });
  std::erase_if(recordings.gnss.fixes, [&](const record::GnssFix& f) { return f.t > end; });
  const PreparedMission mission(std::move(recordings.imu), std::move(recordings.gnss), std::move(setup), {});
  if (outage.start < mission.start().nav.t)
    throw InputError({"", 0, fmt::format("an outage {:.3f} s after the start of the scenario", outage.start - scenario.start),
                      fmt::format("one after the alignment, from {:.3f} s on", mission.start().nav.t - scenario.start), ""});
  OutageRecorder forward(outage, truth, Eigen::Vector3d::Zero(), mission.mission());
  OutageRecorder smoothed(outage, truth, Eigen::Vector3d::Zero(), mission.mission());
  SolutionOutputs outputs;
  outputs.forward = [&](const record::TrajectoryEpoch& epoch) { forward.add(epoch); };
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) { smoothed.add(epoch); };
  static_cast<void>(solve(mission, mission.options(), true, outputs, {}));
  return {outage, forward.errors(), smoothed.errors()};
}

}  // namespace coast::study
