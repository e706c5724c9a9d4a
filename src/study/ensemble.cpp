#include "coast/study/ensemble.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

#include "coast/ins/mounting.hpp"
#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "seed_outage.hpp"

namespace coast::study {

namespace {

std::vector<OutageGroup> groups_of(const EnsemblePlan& plan, const simulate::ErrorFreeMission& mission) {
  std::vector<OutageGroup> groups = plan.groups;
  if (groups.empty())
    for (const simulate::StudiedOutage& own : mission.outages())
      groups.push_back({own.duration, {own.start - plan.scenario.start}});
  if (groups.empty())
    throw InputError(
        {"", 0, "no outage, neither in the study nor in its scenario", "outages: [{start_s: .., duration_s: ..}]", ""});
  const double end = plan.scenario.motion.duration;
  for (const OutageGroup& group : groups)
    for (const double start : group.starts_s)
      if (!(start > 0.0 && group.duration_s > 0.0 && start + group.duration_s < end))
        throw InputError({"", 0, fmt::format("an outage from {:.3f} s for {:g} s", start, group.duration_s),
                          fmt::format("one within the scenario's {:g} s", end),
                          "start_s counts from the start of the scenario."});
  return groups;
}

/// Data common to all recordings of the ensemble.
struct Shared {
  const EnsemblePlan& plan;
  const simulate::ErrorFreeMission mission;
  const std::vector<OutageGroup> groups;
  geo::GpsTime first_outage;

  explicit Shared(const EnsemblePlan& p)
      : plan(p),
        mission(p.scenario, static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism))),
        groups(groups_of(p, mission)) {
    double first = p.scenario.motion.duration;
    for (const OutageGroup& group : groups) first = std::min(first, *std::ranges::min_element(group.starts_s));
    first_outage = p.scenario.start + first;
  }
};

/// For one recording and one of its filters, the outages without known results.
struct Task {
  std::vector<StudyPlace> places;
  std::vector<Outage> outages;
};

class Ensemble {
 public:
  Ensemble(const EnsemblePlan& plan, const StudyJournal& journal) : shared_(plan), journal_(journal) {
    result_.groups = shared_.groups;
    result_.seeds = plan.seeds;
    for (const EnsembleCase& which : plan.cases) {
      first_run_.push_back(result_.runs.size());
      for (const NamedModel& filter : which.filters) {
        result_.runs.push_back({which.truth.name, filter.name, {}});
        for (const OutageGroup& group : shared_.groups)
          result_.runs.back().outages.emplace_back(group.starts_s.size() * plan.seeds);
      }
    }
  }

  void run(std::size_t recording, const std::function<void(double)>& progress);
  [[nodiscard]] std::size_t recordings() const { return shared_.plan.seeds * shared_.plan.cases.size(); }
  [[nodiscard]] StudyResult take() { return std::move(result_); }

 private:
  [[nodiscard]] Task task(std::size_t run, std::size_t seed);
  void solve(const EnsembleCase& which, std::size_t first_run, std::size_t seed);
  [[nodiscard]] OutageResult& at(const StudyPlace& place) { return result_.runs[place.run].outages[place.group][place.outage]; }

  const Shared shared_;
  const StudyJournal& journal_;
  StudyResult result_;
  std::vector<std::size_t> first_run_;  ///< of each case
  std::mutex reporting_;
  std::size_t done_ = 0;
};

// The first outage of a group is always run: its series is drawn, and is not in the journal.
Task Ensemble::task(std::size_t run, std::size_t seed) {
  Task task;
  for (std::size_t g = 0; g < shared_.groups.size(); ++g)
    for (std::size_t i = 0; i < shared_.groups[g].starts_s.size(); ++i) {
      const StudyPlace place{run, g, i * shared_.plan.seeds + seed};
      const Outage outage{shared_.plan.scenario.start + shared_.groups[g].starts_s[i], shared_.groups[g].duration_s};
      if (place.outage > 0 && journal_.known) {
        const std::scoped_lock lock(reporting_);
        if (const std::optional<OutageResult> known = journal_.known(place)) {
          at(place) = *known;
          at(place).outage = outage;
          continue;
        }
      }
      task.places.push_back(place);
      task.outages.push_back(outage);
    }
  return task;
}

void Ensemble::solve(const EnsembleCase& which, std::size_t first_run, std::size_t seed) {
  std::optional<simulate::ErrorFreeMission::Recordings> recordings;
  for (std::size_t f = 0; f < which.filters.size(); ++f) {
    const Task left = task(first_run + f, seed);
    if (left.outages.empty()) continue;
    if (!recordings) {
      recordings = shared_.mission.recorded(which.truth.model, shared_.plan.first_seed + seed);
      ins::to_body(recordings->imu, ins::C_s_b(shared_.plan.scenario.mounting));
    }
    std::vector<OutageResult> results = solve_outages(shared_.plan.scenario, shared_.mission.truth(), *recordings,
                                                      which.filters[f], shared_.first_outage, left.outages);
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (left.places[i].outage > 0) results[i].forward.series = results[i].smoothed->series = {};
      if (journal_.finished) {
        const std::scoped_lock lock(reporting_);
        journal_.finished(left.places[i], results[i]);
      }
      at(left.places[i]) = std::move(results[i]);
    }
  }
}

void Ensemble::run(std::size_t recording, const std::function<void(double)>& progress) {
  const std::size_t seed = recording / shared_.plan.cases.size();
  const std::size_t which = recording % shared_.plan.cases.size();
  try {
    // A thread that waits inside one recording must not begin another: each needs its own memory.
    tbb::this_task_arena::isolate([&] { solve(shared_.plan.cases[which], first_run_[which], seed); });
  } catch (const NumericalError& error) {
    throw NumericalError(
        fmt::format("seed {} of truth {}", shared_.plan.first_seed + seed, shared_.plan.cases[which].truth.name), "",
        error.what());
  }
  if (!progress) return;
  const std::scoped_lock lock(reporting_);
  progress(static_cast<double>(++done_) / static_cast<double>(recordings()));
}

}  // namespace

StudyResult run_ensemble(const EnsemblePlan& plan, const std::function<void(double)>& progress, const StudyJournal& journal) {
  Ensemble ensemble(plan, journal);
  coast::parallel_for(std::size_t{0}, ensemble.recordings(), [&](std::size_t i) { ensemble.run(i, progress); });
  return ensemble.take();
}

}  // namespace coast::study
