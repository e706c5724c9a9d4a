#include "coast/study/ensemble.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "coast/ins/mounting.hpp"
#include "coast/record/error.hpp"
#include "seed_outage.hpp"

namespace coast::study {

namespace {

std::vector<ElapsedOutage> elapsed_outages(const EnsemblePlan& plan, const simulate::ErrorFreeMission& mission) {
  std::vector<ElapsedOutage> outages = plan.outages;
  if (outages.empty())
    for (const simulate::StudiedOutage& own : mission.outages())
      outages.push_back({own.start - plan.scenario.start, own.duration});
  if (outages.empty())
    throw InputError(
        {"", 0, "no outage, neither in the study nor in its scenario", "outages: [{start_s: .., duration_s: ..}]", ""});
  const double end = plan.scenario.motion.duration;
  for (const ElapsedOutage& outage : outages)
    if (!(outage.start_s > 0.0 && outage.duration_s > 0.0 && outage.start_s + outage.duration_s < end))
      throw InputError({"", 0, fmt::format("an outage from {:.3f} s for {:g} s", outage.start_s, outage.duration_s),
                        fmt::format("one within the scenario's {:g} s", end),
                        "start_s counts from the start of the scenario."});
  return outages;
}

/// What every recording of the ensemble shares.
struct Shared {
  const EnsemblePlan& plan;
  const simulate::ErrorFreeMission mission;
  const std::vector<ElapsedOutage> elapsed;
  std::vector<Outage> outages;

  explicit Shared(const EnsemblePlan& p)
      : plan(p),
        mission(p.scenario, static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism))),
        elapsed(elapsed_outages(p, mission)) {
    for (const ElapsedOutage& outage : elapsed) outages.push_back({p.scenario.start + outage.start_s, outage.duration_s});
  }
};

// One seed of one case: simulated once, processed with every filter. [filter][outage]
std::vector<std::vector<OutageResult>> run_seed(const Shared& shared, const EnsembleCase& which, std::uint64_t seed) {
  try {
    simulate::ErrorFreeMission::Recordings recordings = shared.mission.recorded(which.truth.model, seed);
    ins::to_body(recordings.imu, ins::C_s_b(shared.plan.scenario.mounting));
    std::vector<std::vector<OutageResult>> results;
    for (const NamedModel& filter : which.filters) {
      results.emplace_back();
      for (const Outage& outage : shared.outages)
        results.back().push_back(solve_outage(shared.plan.scenario, shared.mission.truth(), recordings, filter.model, outage));
    }
    return results;
  } catch (const NumericalError& error) {
    throw NumericalError(fmt::format("seed {} of truth {}", seed, which.truth.name), "", error.what());
  }
}

EnsembleResult empty_result(const Shared& shared) {
  EnsembleResult result;
  result.outages = shared.elapsed;
  for (const EnsembleCase& which : shared.plan.cases)
    for (const NamedModel& filter : which.filters)
      result.runs.push_back(
          {which.truth.name, filter.name, std::vector(shared.outages.size(), std::vector<OutageResult>(shared.plan.seeds))});
  return result;
}

}  // namespace

EnsembleResult run_ensemble(const EnsemblePlan& plan, const std::function<void(double)>& progress) {
  const Shared shared(plan);
  EnsembleResult result = empty_result(shared);
  std::vector<std::size_t> first_run;  // of each case
  std::size_t runs = 0;
  for (const EnsembleCase& which : plan.cases) {
    first_run.push_back(runs);
    runs += which.filters.size();
  }
  const std::size_t recordings = plan.seeds * plan.cases.size();
  std::size_t done = 0;
  std::mutex reporting;
  tbb::parallel_for(std::size_t{0}, recordings, [&](std::size_t i) {
    const std::size_t seed = i / plan.cases.size();
    const std::size_t which = i % plan.cases.size();
    std::vector<std::vector<OutageResult>> of_seed;
    // A thread that waits inside one recording must not begin another: each needs its memory.
    tbb::this_task_arena::isolate([&] { of_seed = run_seed(shared, plan.cases[which], plan.first_seed + seed); });
    for (std::size_t filter = 0; filter < of_seed.size(); ++filter)
      for (std::size_t outage = 0; outage < of_seed[filter].size(); ++outage) {
        OutageResult& slot = result.runs[first_run[which] + filter].outages[outage][seed];
        slot = std::move(of_seed[filter][outage]);
        if (seed > 0) slot.forward.series = slot.smoothed->series = {};
      }
    if (!progress) return;
    const std::scoped_lock lock(reporting);
    progress(static_cast<double>(++done) / static_cast<double>(recordings));
  });
  return result;
}

std::vector<double> drifts(std::span<const OutageResult> outages, DriftMeasure measure, bool smoothed) {
  std::vector<double> values;
  for (const OutageResult& outage : outages) {
    const OutageErrors& errors = smoothed ? *outage.smoothed : outage.forward;
    values.push_back(measure == DriftMeasure::kHorizontal ? errors.horizontal_max_m
                                                          : errors.max_m(static_cast<Eigen::Index>(measure)));
  }
  return values;
}

Spread spread_of(const std::vector<double>& absolute_errors) {
  double square = 0.0;
  for (const double error : absolute_errors) square += error * error;
  const double rms = std::sqrt(square / static_cast<double>(absolute_errors.size()));
  return {quantile(absolute_errors, 0.5), rms, quantile(absolute_errors, 0.95)};
}

EnsembleDrift ensemble_drift(std::span<const OutageResult> outages, bool smoothed) {
  EnsembleDrift drift;
  double inside = 0.0;
  double tested = 0.0;
  std::array<std::vector<double>, 3> end;
  for (const OutageResult& outage : outages) {
    const OutageErrors& errors = smoothed ? *outage.smoothed : outage.forward;
    for (Eigen::Index axis = 0; axis < 3; ++axis) end[static_cast<std::size_t>(axis)].push_back(std::abs(errors.end_m(axis)));
    drift.predicted_end_rms_m += errors.sigma_end_m.cwiseAbs2() / static_cast<double>(outages.size());
    inside += static_cast<double>(errors.inside_95);
    tested += static_cast<double>(errors.tested);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    drift.largest[axis] = spread_of(drifts(outages, static_cast<DriftMeasure>(axis), smoothed));
    drift.end[axis] = spread_of(end[axis]);
  }
  drift.predicted_end_rms_m = drift.predicted_end_rms_m.cwiseSqrt();
  drift.horizontal = spread_of(drifts(outages, DriftMeasure::kHorizontal, smoothed));
  drift.inside_95 = tested > 0.0 ? inside / tested : 0.0;
  return drift;
}

double gyro_noise_drift(geo::Psd gyro_density, double duration_s) {
  constexpr double kGravity = 9.80665;  // m/s^2; the drift is wanted to two digits
  return kGravity * std::sqrt(gyro_density.value * std::pow(duration_s, 5) / 20.0);
}

}  // namespace coast::study
