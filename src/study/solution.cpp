#include "coast/study/solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>

#include "stage.hpp"

namespace coast::study {

namespace {

/// Events on the batch solution in addition to its states.
void note_batch(const estimate::BatchSolution& batch, const std::vector<estimate::KnotMeasurement>& measurements,
                record::Events& events) {
  constexpr double kDoubted = 0.5;
  const auto end = batch.smoothed.back().nav.t;
  std::size_t doubted = 0;
  for (std::size_t i = 0; i < batch.weights.size(); ++i)
    if (measurements[i].what.kind == estimate::UpdateKind::kGnssPosition && batch.weights[i] < kDoubted) ++doubted;
  events.push_back(
      {record::Event::Severity::kInfo, "batch",
       fmt::format("batch solution after {} iterations; {} GNSS positions left out or at less than half their weight",
                   batch.report.cost.size(), doubted),
       end, 1});
  constexpr double kTolerable = 0.01;
  if (batch.report.rounding() > kTolerable)
    events.push_back(
        {record::Event::Severity::kWarning, "batch_ill_conditioned",
         fmt::format("the normal equations of the batch have the condition number {:.0e}: its states are off by some {:.2g} of "
                     "their sigmas and these by as much of themselves; take `smoother: rts`, which does not need them",
                     batch.report.condition, batch.report.rounding()),
         end, 1});
  if (!batch.report.converged)
    events.push_back({record::Event::Severity::kWarning, "batch_not_converged",
                      "the batch solution has not come to rest: do not trust it where it differs from `smoother: rts`", end,
                      1});
}

// The solution is relative to the lever arm and time offset found by the preparation; users need differences from their own.
void tell_against_configuration(const PreparedMission& mission, std::vector<estimate::MissionUnknown>& unknowns) {
  const Eigen::Vector3d moved = mission.mission().lever_arm_b - mission.setup().lever_arm_b;
  const std::array<const char*, 3> components{"lever_arm forward", "lever_arm right", "lever_arm down"};
  for (estimate::MissionUnknown& unknown : unknowns) {
    for (std::size_t i = 0; i < 3; ++i)
      if (unknown.name == components[i]) unknown.estimate += moved(static_cast<Eigen::Index>(i));
    if (unknown.name == "gnss_time_offset") unknown.estimate += mission.mission().time_offset_s - mission.setup().time_offset_s;
  }
}

std::vector<estimate::SmoothedKnot> smoothed(const PreparedMission& mission, const estimate::FilterOptions& options,
                                             const estimate::FilterState& start,
                                             const std::vector<estimate::KnotMeasurement>& measurements,
                                             const SolutionOutputs& outputs, const Progress& progress,
                                             const estimate::BackwardKnots* backward, Solution& solution) {
  const estimate::StateLayout& layout = solution.filter->layout();
  if (backward != nullptr) {
    estimate::Combination both =
        estimate::combine(solution.knots, *backward, layout, stage(progress, "combining forward and backward"));
    std::ranges::move(both.events, std::back_inserter(solution.forward.events));
    return std::move(both.knots);
  }
  if (!mission.setup().batch)
    return estimate::smooth(solution.knots, layout, stage(progress, "smoothing backward"), outputs.states);
  estimate::BatchSolution batch =
      estimate::smooth_batch(mission.mission(), layout, options, start, solution.knots, measurements, *mission.setup().batch,
                             stage(progress, "solving the batch"), outputs.states);
  note_batch(batch, measurements, solution.forward.events);
  solution.batch = std::move(batch.report);
  tell_against_configuration(mission, solution.batch->unknowns);
  return std::move(batch.smoothed);
}

}  // namespace

Solution solve(const PreparedMission& mission, const estimate::FilterOptions& options, bool smooth,
               const SolutionOutputs& outputs, const Progress& progress, const std::optional<estimate::FilterState>& carried,
               const estimate::BackwardKnots* backward) {
  if (carried && backward != nullptr) throw std::invalid_argument("solve: a combined solution of more than one pass");
  Solution solution;
  solution.filter = std::make_unique<estimate::ForwardFilter>(mission.mission(), mission.model(), options);
  const estimate::FilterState start = mission.start_state(*solution.filter);
  std::vector<estimate::KnotMeasurement> measurements;
  estimate::FilterOutputs for_smoother;
  for_smoother.knots = &solution.knots;
  if (mission.setup().batch)
    for_smoother.measurements = [&](const estimate::Measurement& what, bool used) {
      measurements.push_back({solution.knots.size(), what, used});
    };
  estimate::FilterOutputs filter_outputs;
  if (smooth && !carried) filter_outputs = for_smoother;
  if (outputs.measurements)
    filter_outputs.measurements = [&, for_batch = filter_outputs.measurements](const estimate::Measurement& what, bool used) {
      outputs.measurements(what, used);
      if (for_batch) for_batch(what, used);
    };
  filter_outputs.epochs = outputs.forward;
  filter_outputs.at_knots = outputs.at_knots;
  filter_outputs.progress = stage(progress, "filtering forward");
  solution.forward = solution.filter->run(carried.value_or(start), filter_outputs);
  if (!smooth) return solution;
  const estimate::FilterState smoothed_start = carried ? estimate::FilterState{carried->nav, carried->x, start.P} : start;
  if (carried) {
    for_smoother.progress = stage(progress, "filtering forward for the smoother");
    static_cast<void>(solution.filter->run(smoothed_start, for_smoother));
  }
  solution.smoothed = smoothed(mission, options, smoothed_start, measurements, outputs, progress, backward, solution);
  if (outputs.smoothed)
    estimate::emit_smoothed(mission.mission(), solution.filter->layout(), solution.knots, solution.smoothed, outputs.smoothed,
                            stage(progress, "writing the smoothed trajectory"));
  return solution;
}

estimate::BackwardKnots backward_knots(PreparedMission& mission, const estimate::FilterOptions& options,
                                       const estimate::KnotSampling& states, const Progress& progress) {
  const estimate::ForwardFilter filter(mission.mission(), mission.model(), options);
  estimate::FilterOptions same_knots = options;
  estimate::FilterOutputs outputs;
  outputs.at_knots = [&](const estimate::FilterState& state) { same_knots.knots_at.push_back(state.nav.t); };
  outputs.progress = stage(progress, "filtering forward");
  const estimate::FilterState begin = mission.ignorant_end(filter.run(mission.start_state(filter), outputs).last);
  estimate::BackwardKnots knots(filter.layout(), same_knots.knots_at, begin, states);
  static_cast<void>(mission.run_backward(
      same_knots, begin, [&](const estimate::FilterState& state) { knots.add(state); }, progress));
  return knots;
}

estimate::FilterState carried_start(PreparedMission& mission, const estimate::FilterOptions& options, int passes,
                                    const Progress& progress) {
  const estimate::ForwardFilter filter(mission.mission(), mission.model(), options);
  estimate::FilterState state = mission.start_state(filter);
  estimate::FilterOutputs outputs;
  outputs.progress = stage(progress, "filtering forward");
  for (int done = 1; done < passes; done += 2)
    state = mission.run_backward(options, filter.run(state, outputs).last, {}, progress);
  return state;
}

LeverArmCheck check_lever_arm(const PreparedMission& mission, double prior_sd_m, const Progress& progress) {
  estimate::FilterOptions options = mission.options();
  options.auxiliary.lever_arm_sd_m = prior_sd_m;
  estimate::ForwardFilter filter(mission.mission(), mission.model(), options);
  estimate::FilterOutputs outputs;
  outputs.progress = stage(progress, "checking the lever arm");
  const estimate::FilterState last = filter.run(mission.start_state(filter), outputs).last;
  const Eigen::Index at = *filter.layout().lever_arm();
  const Eigen::Vector3d moved = mission.mission().lever_arm_b - mission.setup().lever_arm_b;  // by the estimate so far
  return {moved + last.x.segment<3>(at), last.P.diagonal().segment<3>(at).cwiseSqrt()};
}

}  // namespace coast::study
