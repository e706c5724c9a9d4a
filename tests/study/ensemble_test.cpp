#include "coast/study/ensemble.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "coast/record/error.hpp"
#include "simulated.hpp"
#include "support/support.hpp"

namespace coast::study {
namespace {

constexpr ElapsedOutage kOutage{130.0, 20.0};  // the recordings end at its 130 + 20 + 180 s

/// A city drive; the recordings of the ensemble end with it or `kTail` after the outage.
EnsemblePlan plan(std::size_t seeds) {
  EnsemblePlan p;
  p.scenario = test::drive(340.0, 0);
  p.scenario.gnss.rate_hz = 2.0;
  p.first_seed = 5;
  p.seeds = seeds;
  p.outages = {kOutage};
  const NamedModel model{"tactical", test::tactical_model()};
  p.cases = {{model, {model}}};
  return p;
}

/// A seed by itself, from a recording that never had the fixes of the outage.
OutageResult by_hand(const EnsemblePlan& p, std::uint64_t seed, const noise::ImuErrorModel& model) {
  simulate::Scenario scenario = p.scenario;
  scenario.seed = seed;
  scenario.gnss.gaps = {{kOutage.start_s, kOutage.duration_s}};
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const Outage outage{scenario.start + kOutage.start_s, kOutage.duration_s};
  const geo::GpsTime end = outage.span().to + kTail;
  std::erase_if(recording.imu.samples, [&](const record::ImuSample& s) { return s.t > end; });
  std::erase_if(recording.gnss.fixes, [&](const record::GnssFix& f) { return f.t > end; });
  Setup setup = test::setup_of(scenario);
  setup.model = model;
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
  const noise::ImuErrorModel doubled = p.cases[0].truth.model.with_white_noise_scaled(noise::Sensor::kGyro, 2.0);
  p.cases[0].filters.push_back({"gyro noise doubled", doubled});
  const EnsembleResult result = run_ensemble(p);
  ASSERT_EQ(result.runs.size(), 2U);
  for (std::size_t run = 0; run < 2; ++run)
    for (std::size_t seed = 0; seed < 2; ++seed) {
      const OutageResult& of_ensemble = result.runs[run].outages[0][seed];
      const OutageResult expected = by_hand(p, p.first_seed + seed, p.cases[0].filters[run].model);
      // Knots stand at withheld fixes in the one and every half second in the other: exact to the folding of the transition.
      EXPECT_LE(in_sigmas(of_ensemble.forward, expected.forward), 1e-4) << run << " " << seed;
      EXPECT_LE(in_sigmas(*of_ensemble.smoothed, *expected.smoothed), 1e-4) << run << " " << seed;
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
    const EnsembleResult result = run_ensemble(p, [&](double fraction) { fractions.push_back(fraction); });
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
  const EnsembleResult result = run_ensemble(plan(kSeeds));
  const std::vector<OutageResult>& seeds = result.runs[0].outages[0];
  const auto bounds = test::chi2_mean_bounds(1.0, kSeeds, 0.9999);  // three axes, two solutions: one false alarm in 1700
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double forward = 0.0;
    for (const OutageResult& seed : seeds) forward += std::pow(seed.forward.end_m(axis) / seed.forward.sigma_end_m(axis), 2);
    EXPECT_GE(forward / kSeeds, bounds.lower) << axis;
    EXPECT_LE(forward / kSeeds, bounds.upper) << axis;
  }
  const EnsembleDrift drift = ensemble_drift(seeds, false);
  // The gyros of the model alone, with everything else known, set a floor that no filter states less than.
  const geo::Psd density = plan(1).cases[0].truth.model.white_density(noise::Sensor::kGyro, 0);
  EXPECT_GE(drift.predicted_end_rms_m.x(), gyro_noise_drift(density, kOutage.duration_s));
  EXPECT_GE(drift.predicted_end_rms_m.y(), gyro_noise_drift(density, kOutage.duration_s));
}

TEST(Ensemble, RefusesOutagesThatCannotBe) {
  EnsemblePlan p = plan(1);
  p.outages = {{330.0, 20.0}};  // 10 s beyond the end
  EXPECT_THROW(static_cast<void>(run_ensemble(p)), InputError);
  p.outages.clear();  // and none in the scenario
  EXPECT_THROW(static_cast<void>(run_ensemble(p)), InputError);
}

OutageResult outage(const Eigen::Vector3d& end, double horizontal, std::size_t inside) {
  OutageErrors errors;
  errors.end_m = end;
  errors.max_m = 2.0 * end.cwiseAbs();
  errors.sigma_end_m = Eigen::Vector3d(3.0, 4.0, 5.0);
  errors.horizontal_max_m = horizontal;
  errors.inside_95 = inside;
  errors.tested = 10;
  return {{geo::GpsTime(), 20.0}, errors, errors};
}

TEST(EnsembleDrift, ByHand) {
  const std::vector<OutageResult> seeds{outage({3.0, -1.0, 0.0}, 5.0, 10), outage({-4.0, 1.0, 2.0}, 7.0, 8)};
  const EnsembleDrift d = ensemble_drift(seeds, true);
  EXPECT_NEAR(d.end[0].rms, std::sqrt(12.5), 1e-14);
  EXPECT_NEAR(d.end[0].median, 3.5, 1e-14);
  EXPECT_NEAR(d.end[1].rms, 1.0, 1e-14);
  EXPECT_NEAR(d.largest[2].rms, std::sqrt(8.0), 1e-14);
  EXPECT_NEAR(d.horizontal.median, 6.0, 1e-14);
  EXPECT_NEAR(d.horizontal.p95, 6.9, 1e-14);
  EXPECT_NEAR(d.predicted_end_rms_m.y(), 4.0, 1e-14);
  EXPECT_NEAR(d.inside_95, 0.9, 1e-14);
  EXPECT_EQ(drifts(seeds, DriftMeasure::kNorth, false), (std::vector<double>{6.0, 8.0}));
}

// White noise into a tilt, its specific force into a velocity, that into a position: covariance step by step.
TEST(GyroNoiseDrift, AgreesWithPropagation) {
  constexpr double kDensity = 1.9e-9;  // rad^2/s: 0.15 deg/sqrt(h)
  constexpr double kDuration = 130.0;
  constexpr double kStep = 1e-3;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(1, 0) = 9.80665 * kStep;
  F(2, 1) = kStep;
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (int k = 0; k < static_cast<int>(kDuration / kStep); ++k) {
    P = (F * P * F.transpose()).eval();
    P(0, 0) += kDensity * kStep;
  }
  // First order in the step: 5/2 kStep / kDuration at most.
  EXPECT_NEAR(gyro_noise_drift({kDensity}, kDuration) / std::sqrt(P(2, 2)), 1.0, 5e-5);
}

}  // namespace
}  // namespace coast::study
