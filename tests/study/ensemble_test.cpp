#include "coast/study/ensemble.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <map>
#include <set>

#include "coast/record/error.hpp"
#include "simulated.hpp"
#include "support/support.hpp"

namespace coast::study {
namespace {

constexpr double kOutageStart = 130.0;
constexpr double kOutageDuration = 20.0;

/// A city drive without GNSS for a while.
EnsemblePlan plan(std::size_t seeds) {
  EnsemblePlan p;
  p.scenario = test::drive(340.0, 0);
  p.scenario.gnss.rate_hz = 2.0;
  p.first_seed = 5;
  p.seeds = seeds;
  p.groups = {{kOutageDuration, {kOutageStart}}};
  const NamedModel model{"tactical", test::tactical_model()};
  p.cases = {{model, {model}}};
  return p;
}

/// A seed by itself, from a recording that never had the fixes of the outage.
OutageResult by_hand(const EnsemblePlan& p, std::uint64_t seed, const NamedModel& model) {
  simulate::Scenario scenario = p.scenario;
  scenario.seed = seed;
  scenario.gnss.gaps = {{kOutageStart, kOutageDuration}};
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const Outage outage{scenario.start + kOutageStart, kOutageDuration};
  Setup setup = test::setup_of(scenario);
  setup.model = model.model;
  setup.batch = model.batch;
  setup.refine_before = outage.start;
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), std::move(setup), {});
  OutageRecorder forward(outage, recording.truth, Eigen::Vector3d::Zero(), mission.mission());
  OutageRecorder smoothed(outage, recording.truth, Eigen::Vector3d::Zero(), mission.mission());
  SolutionOutputs outputs;
  outputs.forward = [&](const record::TrajectoryEpoch& epoch) { forward.add(epoch); };
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) { smoothed.add(epoch); };
  static_cast<void>(solve(mission, mission.options(), true, outputs, {}));
  return {outage, forward.errors(), smoothed.errors()};
}

double in_sigmas(const OutageErrors& a, const OutageErrors& b) {
  return ((a.max_m - b.max_m).array() / b.sigma_max_m.array()).abs().maxCoeff();
}

TEST(Ensemble, EqualsSeedsProcessedOneByOneWithoutTheFixesOfTheOutage) {
  EnsemblePlan p = plan(2);
  const NamedModel own = p.cases[0].truth;
  p.cases[0].filters.push_back({"gyro noise doubled",
                                own.model.with_white_noise_scaled(noise::Sensor::kGyro, Eigen::Vector3d::Constant(2.0)),
                                std::nullopt});
  p.cases[0].filters.push_back({"as a batch", own.model, estimate::BatchOptions{}});
  const StudyResult result = run_ensemble(p);
  ASSERT_EQ(result.runs.size(), 3U);
  for (std::size_t run = 0; run < 3; ++run)
    for (std::size_t seed = 0; seed < 2; ++seed) {
      EXPECT_EQ(result.runs[run].filter, p.cases[0].filters[run].name);
      const OutageResult& of_ensemble = result.runs[run].outages[0][seed];
      const OutageResult expected = by_hand(p, p.first_seed + seed, p.cases[0].filters[run]);
      // Knots stand at withheld fixes in the one and every half second in the other: exact to the folding of the transition.
      EXPECT_LE(in_sigmas(of_ensemble.forward, expected.forward), 1e-5) << run << " " << seed;
      // What follows behind the outage is linearised about the run without it.
      EXPECT_LE(in_sigmas(*of_ensemble.smoothed, *expected.smoothed), 1e-3) << run << " " << seed;
      EXPECT_EQ(of_ensemble.forward.series.empty(), seed > 0);
    }
  const auto drift = drifts(result.runs[0].outages[0], DriftMeasure::kHorizontal, false);
  EXPECT_NE(drift[0], drift[1]);
  EXPECT_EQ(drift[1], result.runs[0].outages[0][1].forward.horizontal_max_m);
}

TEST(Ensemble, SameNumbersForAnyNumberOfThreads) {
  const EnsemblePlan p = plan(3);
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<double> fractions;
    const StudyResult result = run_ensemble(p, [&](double fraction) { fractions.push_back(fraction); });
    EXPECT_EQ(fractions.size(), 3U);
    EXPECT_EQ(fractions.back(), 1.0);
    std::vector<double> errors;
    for (const bool smoothed : {false, true})
      for (const double error : drifts(result.runs[0].outages[0], DriftMeasure::kEast, smoothed)) errors.push_back(error);
    return errors;
  };
  EXPECT_EQ(with_threads(1), with_threads(3));
}

// Where the filter knows what the sensors do, its sigmas are those of the errors.
TEST(Ensemble, ErrorsAreAsLargeAsStated) {
  constexpr std::size_t kSeeds = 12;
  const StudyResult result = run_ensemble(plan(kSeeds));
  const std::vector<OutageResult>& seeds = result.runs[0].outages[0];
  const auto bounds = test::chi2_mean_bounds(1.0, kSeeds, 0.9999);  // three axes, two solutions: one false alarm in 1700
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double forward = 0.0;
    for (const OutageResult& seed : seeds) forward += std::pow(seed.forward.end_m(axis) / seed.forward.sigma_end_m(axis), 2);
    EXPECT_GE(forward / kSeeds, bounds.lower) << axis;
    EXPECT_LE(forward / kSeeds, bounds.upper) << axis;
  }
  const Drift drift = drift_of(seeds, false);
  // The gyros of the model alone, with everything else known, set a floor that no filter states less than.
  const geo::Psd density = plan(1).cases[0].truth.model.white_density(noise::Sensor::kGyro, 0);
  EXPECT_GE(drift.predicted_end_rms_m.x(), gyro_noise_drift(density, kOutageDuration));
  EXPECT_GE(drift.predicted_end_rms_m.y(), gyro_noise_drift(density, kOutageDuration));
}

// Start by start, within it seed by seed; and what a journal has is not computed again.
TEST(Ensemble, GoesOnFromAJournal) {
  EnsemblePlan p = plan(2);
  p.groups = {{20.0, {100.0, 150.0}}, {5.0, {200.0}}};
  std::map<std::array<std::size_t, 3>, OutageResult> written;
  StudyJournal journal;
  const auto key = [](const StudyPlace& place) { return std::array{place.run, place.group, place.outage}; };
  journal.finished = [&](const StudyPlace& place, const OutageResult& result) {
    EXPECT_TRUE(written.emplace(key(place), result).second);
  };
  const StudyResult whole = run_ensemble(p, {}, journal);
  ASSERT_EQ(written.size(), 6U);
  for (const auto& [place, result] : written) {
    const std::size_t start = place[2] / p.seeds;
    EXPECT_EQ(result.outage.start, p.scenario.start + p.groups[place[1]].starts_s[start]);
    EXPECT_EQ(result.outage.duration_s, p.groups[place[1]].duration_s);
    EXPECT_EQ(result.forward.max_m, whole.runs[place[0]].outages[place[1]][place[2]].forward.max_m);
  }

  std::set<std::array<std::size_t, 3>> computed;
  journal.known = [&](const StudyPlace& place) -> std::optional<OutageResult> {
    if (place.group == 0 && place.outage == 3) return std::nullopt;
    OutageResult known = written.at(key(place));
    known.outage = {};  // a journal does not have it
    known.forward.horizontal_max_m = 42.0;
    return known;
  };
  journal.finished = [&](const StudyPlace& place, const OutageResult&) { computed.insert(key(place)); };
  const StudyResult again = run_ensemble(p, {}, journal);
  // The first outage of each group is, for its series.
  EXPECT_EQ(computed, (std::set<std::array<std::size_t, 3>>{{0, 0, 0}, {0, 0, 3}, {0, 1, 0}}));
  for (std::size_t group = 0; group < 2; ++group)
    for (std::size_t i = 0; i < whole.runs[0].outages[group].size(); ++i) {
      const OutageResult& a = again.runs[0].outages[group][i];
      const OutageResult& b = whole.runs[0].outages[group][i];
      EXPECT_EQ(a.outage.start, b.outage.start);
      EXPECT_EQ(a.smoothed->max_m, b.smoothed->max_m);
      EXPECT_EQ(a.manoeuvre, b.manoeuvre);
      EXPECT_EQ(a.forward.horizontal_max_m, computed.contains({0, group, i}) ? b.forward.horizontal_max_m : 42.0);
      EXPECT_EQ(a.forward.series.size(), b.forward.series.size());
    }
}

TEST(Ensemble, RefusesOutagesThatCannotBe) {
  EnsemblePlan p = plan(1);
  p.groups = {{20.0, {100.0, 330.0}}};  // 10 s beyond the end
  EXPECT_THROW(static_cast<void>(run_ensemble(p)), InputError);
  p.groups.clear();  // and none in the scenario
  EXPECT_THROW(static_cast<void>(run_ensemble(p)), InputError);
}

}  // namespace
}  // namespace coast::study
