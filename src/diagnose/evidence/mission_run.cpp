#include "evidence/mission_run.hpp"

#include <cmath>

#include "coast/record/error.hpp"
#include "coast/study/outage_runs.hpp"
#include "evidence/turn_on.hpp"

namespace coast::diagnose {

MissionRun::MissionRun(MissionInput input, Grade grade, const std::vector<EffectPtr>& suggested,
                       const study::Progress& progress)
    : mission_(std::move(input.imu), std::move(input.gnss), std::move(input.setup), progress),
      hypotheses_(mission_.mission(), mission_.options(), grade, path_, suggested) {
  study::SolutionOutputs outputs;
  outputs.smoothed = [this](const record::TrajectoryEpoch& epoch) {
    path_.push_back(epoch.nav);
    gap_free_.add(epoch);
  };
  solution_ = study::solve(mission_, mission_.options(), true, outputs, progress);
}

std::optional<estimate::FilterResult> forward(MissionInput input) {
  const study::PreparedMission mission(std::move(input.imu), std::move(input.gnss), std::move(input.setup), {});
  const estimate::ForwardFilter filter(mission.mission(), mission.model(), mission.options());
  try {
    return filter.run(mission.start_state(filter), {});
  } catch (const NumericalError&) {
    return std::nullopt;
  }
}

Fit MissionRun::fit() const {
  const study::OutageSweep sweep{.every_s = 45.0, .first_s = 120.0, .durations_s = {20.0}};
  Fit fit;
  double nis = 0.0;
  double dof = 0.0;
  for (const estimate::InnovationRecord& r : solution_.forward.innovations) {
    if (!r.used) continue;
    nis += r.nis;
    dof += r.dof;
  }
  const auto count = static_cast<double>(solution_.forward.innovations.size());
  if (dof > 0.0) fit.nis = nis / dof;
  double of_biases = 0.0;  // the run began about the estimated biases
  for (const TurnOn& one : beyond_stated(*this)) of_biases -= one.cost();
  if (count > 0.0) fit.log_likelihood_per_epoch = (log_likelihood() + of_biases) / count;
  const std::vector<study::Outage> outages =
      study::outages_of(sweep, mission_.start().nav.t, mission_.mission().imu.samples.back().t);
  const std::vector<study::OutageResult> results =
      study::run_outages(mission_, solution_.knots, {gap_free_.trajectory()}, outages);
  double sum = 0.0;
  for (const study::OutageResult& result : results) {
    sum += std::pow(result.forward.horizontal_max_m, 2);
    fit.outages_m.push_back(result.forward.horizontal_max_m);
  }
  if (!results.empty()) fit.outage_rms_m = std::sqrt(sum / static_cast<double>(results.size()));
  return fit;
}

}  // namespace coast::diagnose
