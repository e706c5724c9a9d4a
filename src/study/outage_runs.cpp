#include "coast/study/outage_runs.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

#include "coast/parallel.hpp"
#include "stage.hpp"

namespace coast::study {

namespace {

/// Where an outage branches off from the gap-free run and where it rejoins it.
struct Branch {
  std::size_t from = 0;  ///< knot
  geo::GpsTime until;
  std::optional<std::size_t> behind = {};  ///< knot whose future is used there
};

/// Index of the first knot at or after t; size() if there is none.
std::size_t first_knot_at(const estimate::KnotStore& knots, geo::GpsTime t) {
  std::size_t low = 0;
  std::size_t high = knots.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (knots.time(middle) < t)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

Branch branch_of(const estimate::Mission& mission, const estimate::KnotStore& knots, const Outage& outage) {
  Branch branch;
  const std::size_t after = first_knot_at(knots, outage.start - kMargin);
  branch.from = after > 0 ? after - 1 : 0;
  if (mission.carrier != nullptr) {
    branch.until = outage.span().to + kTightTail;
    return branch;
  }
  const std::size_t back = first_knot_at(knots, outage.span().to + kSettle);
  branch.until = knots.time(std::min(back, knots.size() - 1));
  if (back < knots.size()) branch.behind = back;
  return branch;
}

OutageRecorder recorder_of(const PreparedMission& mission, const Truth& truth, const Outage& outage) {
  return {outage, truth.trajectory, truth.lever_arm_b, mission.mission()};
}

estimate::FilterOptions options_without(const PreparedMission& mission, const Outage& outage) {
  estimate::FilterOptions options = mission.options();
  options.withheld.push_back(outage.span());
  return options;
}

OutageResult result_of(const Outage& outage, const OutageRecorder& forward, const OutageRecorder& smoothed,
                       const Truth& truth) {
  return {outage, forward.errors(), smoothed.errors(), manoeuvre_of(truth.trajectory, outage.start, outage.span().to)};
}

OutageResult run_branch(const PreparedMission& mission, const Truth& truth, const Outage& outage, const estimate::Knot& from,
                        geo::GpsTime until, const estimate::Future* behind) {
  const estimate::ForwardFilter filter(mission.mission(), mission.model(), options_without(mission, outage));
  OutageRecorder forward = recorder_of(mission, truth, outage);
  estimate::KnotStore knots;
  estimate::FilterOutputs outputs;
  outputs.knots = &knots;
  outputs.epochs = [&](const record::TrajectoryEpoch& epoch) { forward.add(epoch); };
  static_cast<void>(filter.resume(from, until, outputs));
  OutageRecorder smoothed = recorder_of(mission, truth, outage);
  const estimate::KnotSampling no_states(1e9);
  estimate::emit_smoothed(mission.mission(), filter.layout(), knots,
                          estimate::smooth(knots, filter.layout(), {}, no_states, behind),
                          [&](const record::TrajectoryEpoch& epoch) { smoothed.add(epoch); });
  return result_of(outage, forward, smoothed, truth);
}

/// Futures at the knots where some branch rejoins, by knot.
struct Futures {
  std::vector<std::size_t> at;
  std::vector<estimate::Future> known;

  Futures(const PreparedMission& mission, const estimate::KnotStore& knots, const std::vector<Branch>& branches) {
    for (const Branch& branch : branches)
      if (branch.behind) at.push_back(*branch.behind);
    std::ranges::sort(at);
    at.erase(std::unique(at.begin(), at.end()), at.end());
    const estimate::ForwardFilter filter(mission.mission(), mission.model(), mission.options());
    known = estimate::futures(knots, filter.layout(), at);
  }
  [[nodiscard]] const estimate::Future* of(const Branch& branch) const {
    if (!branch.behind) return nullptr;
    return &known[static_cast<std::size_t>(std::ranges::lower_bound(at, *branch.behind) - at.begin())];
  }
};

}  // namespace

estimate::KnotStore gap_free_knots(const PreparedMission& mission, const Progress& progress) {
  const estimate::ForwardFilter filter(mission.mission(), mission.model(), mission.options());
  estimate::KnotStore knots;
  estimate::FilterOutputs outputs;
  outputs.knots = &knots;
  outputs.progress = stage(progress, "filtering forward");
  static_cast<void>(filter.run(mission.start_state(filter), outputs));
  return knots;
}

std::vector<OutageResult> run_outages(const PreparedMission& mission, const estimate::KnotStore& knots, const Truth& truth,
                                      const std::vector<Outage>& outages, const OutageSink& sink) {
  std::vector<Branch> branches;
  for (const Outage& outage : outages) branches.push_back(branch_of(mission.mission(), knots, outage));
  const Futures futures(mission, knots, branches);
  std::vector<OutageResult> results(outages.size());
  std::mutex shared;  // the store's file and the sink
  coast::parallel_for(std::size_t{0}, outages.size(), [&](std::size_t i) {
    estimate::Knot from;
    {
      const std::scoped_lock lock(shared);
      from = knots.at(branches[i].from);
    }
    // A thread that waits inside one outage must not begin another: each has its own knots in memory.
    tbb::this_task_arena::isolate(
        [&] { results[i] = run_branch(mission, truth, outages[i], from, branches[i].until, futures.of(branches[i])); });
    if (!sink) return;
    const std::scoped_lock lock(shared);
    sink(i, results[i]);
  });
  return results;
}

OutageResult run_outage_whole(const PreparedMission& mission, const Truth& truth, const Outage& outage) {
  OutageRecorder forward = recorder_of(mission, truth, outage);
  OutageRecorder smoothed = recorder_of(mission, truth, outage);
  SolutionOutputs outputs;
  outputs.forward = [&](const record::TrajectoryEpoch& epoch) { forward.add(epoch); };
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) { smoothed.add(epoch); };
  static_cast<void>(solve(mission, options_without(mission, outage), true, outputs, {}));
  return result_of(outage, forward, smoothed, truth);
}

}  // namespace coast::study
