// Every job as a function of values: no program, and no file but the page's program in the library.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>

#include "coast/geo/earth.hpp"
#include "coast/io/yaml.hpp"
#include "coast/jobs/array_study.hpp"
#include "coast/jobs/calibrate.hpp"
#include "coast/jobs/compare.hpp"
#include "coast/jobs/diagnose.hpp"
#include "coast/jobs/estimator_study.hpp"
#include "coast/jobs/outage.hpp"
#include "coast/jobs/ppk.hpp"
#include "coast/jobs/process.hpp"
#include "coast/jobs/simulate.hpp"
#include "coast/jobs/synth.hpp"
#include "ppk/summary.hpp"
#include "support/short_drive.hpp"

namespace coast::jobs {
namespace {

SimulationConfig simulation(const std::string& scenario) {
  const auto model = [](const std::filesystem::path&) { return io::parse_yaml(test::kTestModel, "model.yaml"); };
  return {"scenario.yaml", simulate::Scenario::from(io::parse_yaml(scenario, "scenario.yaml"), model)};
}

const SimulationConfig& drive() {
  static const SimulationConfig config = simulation(test::kShortDrive);
  return config;
}

const SimulationResult& recording() {
  static const SimulationResult result = simulate(drive(), {});
  return result;
}

RunConfig run_of(const simulate::Scenario& scenario) {
  RunConfig run;
  run.setup.model = *scenario.error_model;
  run.setup.lever_arm_b = scenario.gnss.lever_arm_b;
  return run;
}

Recordings recordings_of(const simulate::SimulatedMission& mission) {
  Recordings recordings;
  recordings.imu = mission.imu;
  recordings.gnss = mission.gnss;
  recordings.reference = mission.truth;
  return recordings;
}

TEST(InMemory, ProcessDeliversTheTrajectoryThatItJudges) {
  const ProcessedMission mission = process(run_of(drive().scenario), recordings_of(recording().mission), Progress{});
  const record::Trajectory& truth = recording().mission.truth;
  EXPECT_EQ(mission.delivered.size(), mission.forward.size());
  ASSERT_GT(mission.delivered.size(), 10000U);
  EXPECT_EQ(mission.result.verdict.standing(), Standing::kGood) << mission.result.verdict.line();
  // What the result says of its errors, computed once more from the arrays: states at the same IMU epochs.
  std::size_t k = 0, epochs = 0;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const record::TrajectoryEpoch& epoch : mission.delivered) {
    while (k + 1 < truth.states.size() && truth.states[k].t - epoch.nav.t < -1e-6) ++k;
    const Eigen::Vector3d error_n =
        geo::C_n_e(geo::geodetic_from_ecef(truth.states[k].r_eb_e)).transpose() * (epoch.nav.r_eb_e - truth.states[k].r_eb_e);
    squares += error_n.cwiseAbs2();
    ++epochs;
  }
  const Eigen::Vector3d rms = (squares / static_cast<double>(epochs)).cwiseSqrt();
  const AgainstReference& against = *mission.result.reference;
  const Eigen::Vector3d stated = against.summary(*against.smoothed).position.rms;
  for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(rms(i), stated(i), 1e-3 * stated(i));  // its first epoch is between two
  EXPECT_LT(rms.head<2>().norm(), 0.0142);                                                // of a single fix
}

TEST(InMemory, OutagesAreThoseOfAProcessedMissionsSweep) {
  RunConfig run = run_of(drive().scenario);
  run.sweep = study::OutageSweep{.every_s = 40.0, .first_s = 60.0, .durations_s = {10.0}};
  const Recordings recordings = recordings_of(recording().mission);
  const ProcessResult processed = process(run, recordings, TrajectorySinks{}, Progress{});
  SweepStudy study;
  study.run = run;
  study.sweep = *run.sweep;
  study.models.push_back({{"stated", run.setup.model}, {}});
  const OutageStudy outages = outage(study, recordings, Progress{});
  ASSERT_EQ(outages.result.runs.size(), 1U);
  const std::vector<study::OutageResult>& group = outages.result.runs.front().outages.front();
  ASSERT_EQ(group.size(), processed.sweep.size());
  for (std::size_t i = 0; i < group.size(); ++i) {
    EXPECT_EQ(group[i].forward.horizontal_max_m, processed.sweep[i].forward.horizontal_max_m);
    EXPECT_EQ(group[i].smoothed->horizontal_max_m, processed.sweep[i].smoothed->horizontal_max_m);
  }
}

TEST(InMemory, EnsembleIsTheSameForSeedsAlone) {
  EnsembleStudy study;
  study.plan.scenario = drive().scenario;
  study.plan.seeds = 2;
  study.plan.first_seed = 3;
  study.plan.groups = {{10.0, {100.0}}};
  const study::NamedModel model{"stated", *drive().scenario.error_model};
  study.plan.cases = {{model, {model}}};
  study.truths = study.filters = 1;
  const OutageStudy both = outage(study, Progress{});
  study.plan.seeds = 1;
  study.plan.first_seed = 4;
  const OutageStudy second = outage(study, Progress{});
  ASSERT_EQ(both.result.runs.front().outages.front().size(), 2U);
  EXPECT_EQ(both.result.runs.front().outages.front()[1].smoothed->horizontal_max_m,
            second.result.runs.front().outages.front()[0].smoothed->horizontal_max_m);
}

TEST(InMemory, CalibrateFindsTheVarianceOfWhiteNoise) {
  constexpr double kSd = 1e-3, kInterval = 0.01;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, kSd);
  record::ImuRecording imu;
  imu.source = "in memory";
  imu.rate_hz = 1.0 / kInterval;
  double sum = 0.0, squares = 0.0;
  constexpr int kSamples = 20000;
  for (int i = 1; i <= kSamples; ++i) {
    const double rate = normal(random);
    sum += rate;
    squares += rate * rate;
    imu.samples.push_back({geo::GpsTime::from_week(2374, kInterval * i), kInterval, kInterval * Eigen::Vector3d(rate, 0.0, 0.0),
                           kInterval * Eigen::Vector3d(0.0, 0.0, -9.8)});
  }
  CalibrationConfig config;
  config.sensor = "test";
  config.axes = {{noise::Sensor::kGyro, 0}};
  config.records.emplace_back();
  config.sensors[0].processes = {"white_noise"};
  config.sensors[0].mean = noise::Mean::kLevel;
  const CalibrationResult result = calibrate(config, {imu}, Progress{});
  ASSERT_EQ(result.axes.size(), 1U);
  // The maximum of the restricted likelihood in closed form: the second moment about the mean, over n - 1.
  const double density2 = kInterval * (squares - sum * sum / kSamples) / (kSamples - 1);
  EXPECT_NEAR(std::exp(result.axes.front().result.best().fit.u.front()), density2, 1e-6 * density2);
}

TEST(InMemory, SynthOfPlainMeansIsTheMean) {
  const SimulationConfig config = simulation(R"(
schema: coast.scenario/1
trajectory: {kind: city, duration_s: 280, static_s: 60, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 100, error_model: model.yaml}
gnss: {rate_hz: 1, sd_m: [0.01, 0.01, 0.02]}
array: [{name: one, error_model: model.yaml}, {name: two, error_model: model.yaml}, {name: three, error_model: model.yaml}]
start_gps: {week: 2374, sow: 208800}
)");
  const std::vector<record::ImuRecording> imus = simulate(config, {}).array;
  ArrayConfig array;
  for (const char* name : {"one", "two", "three"}) array.imus.push_back({name, io::ImuFileOptions{}, {}, {}, {}});
  array.merge.merge = array::Merge::kMean;
  const SynthResult result = synth(array, imus, std::nullopt, Progress{});
  const array::Signals& signals = result.assembly.signals;
  ASSERT_EQ(signals.sensors.size(), 3U);
  for (int c = 0; c < array::kChannels; ++c)
    for (const Eigen::Index n : {Eigen::Index{100}, Eigen::Index{5000}, Eigen::Index{9000}}) {
      double mean = 0.0;
      for (const array::SensorSignals& sensor : signals.sensors) mean += sensor.values(c, n) / 3.0;
      EXPECT_NEAR(result.channels[static_cast<std::size_t>(c)].value(n), mean, 1e-2 * std::abs(mean) + 1e-3);
    }
  EXPECT_EQ(synthetic_imu(result).samples.size(), static_cast<std::size_t>(signals.samples()));
}

TEST(InMemory, PpkFixesWhatWasSimulated) {
  const SimulationConfig config = simulation(R"(
schema: coast.scenario/1
trajectory: {kind: city, duration_s: 240, static_s: 20, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 50, error_model: model.yaml}
gnss: {rate_hz: 1, sd_m: [0.01, 0.01, 0.02], observations: {systems: [gps], rate_hz: 1, base_ned_m: [300, 100, 0]}}
start_gps: {week: 2374, sow: 208800}
seed: 5
)");
  const SimulationResult simulated = simulate(config, {});
  const simulate::SimulatedObservations& observed = *simulated.observations;
  PpkConfig ppk_config;
  ppk_config.base_at = {carrier::BaseAt::How::kGiven, observed.r_base_e};
  PpkRecordings recordings;
  recordings.rover = observed.rover;
  recordings.base = observed.base;
  recordings.navigation = observed.navigation;
  const PpkResult result = ppk(ppk_config, recordings, Progress{});
  std::size_t fixed = 0;
  for (const record::GnssFix& fix : result.fixes.fixes) fixed += fix.quality == record::FixQuality::kFixed ? 1U : 0U;
  EXPECT_GT(fixed, 150U);
  EXPECT_EQ((result.r_base_e - observed.r_base_e).norm(), 0.0);

  // Where the base is taken from its own codes, vectors between the antennas remain as they are.
  ppk_config.base_at.how = carrier::BaseAt::How::kMoving;
  const PpkResult moving = ppk(ppk_config, recordings, Progress{});
  std::istringstream rows(baselines_csv(moving));
  std::string row;
  std::getline(rows, row);
  std::size_t compared = 0;
  while (std::getline(rows, row)) {
    double week = 0.0, sow = 0.0, n = 0.0, e = 0.0, d = 0.0, sdn = 0.0, sde = 0.0, sdd = 0.0, length = 0.0;
    int quality = 0;
    ASSERT_EQ(std::sscanf(row.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%d", &week, &sow, &n, &e, &d, &sdn, &sde, &sdd,
                          &length, &quality),
              10)
        << row;
    EXPECT_GT(std::min({sdn, sde, sdd}), 0.0) << row;  // or it could not be read back
    if (quality != 1) continue;
    const geo::GpsTime t = geo::GpsTime::from_week(static_cast<int>(week), sow);
    const auto truth = std::ranges::lower_bound(simulated.mission.truth.states, t - 1e-3, {}, &record::NavState::t);
    if (truth == simulated.mission.truth.states.end() || truth->t - t > 1e-3) continue;
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(truth->r_eb_e)).transpose();
    EXPECT_LE((Eigen::Vector3d(n, e, d) - C_e_n * (truth->r_eb_e - observed.r_base_e)).norm(), 0.05) << row;
    EXPECT_NEAR(Eigen::Vector3d(n, e, d).norm(), length, 1e-3);
    ++compared;
  }
  EXPECT_GT(compared, 100U);
}

TEST(InMemory, EstimatorStudyMeetsTheVarianceOfWhiteNoise) {
  const noise::SumModel white({&noise::estimable("white_noise")}, noise::Mean::kLevel);
  EstimatorStudyConfig config;
  config.study.truth = {white, {std::log(4.0)}};
  config.study.samples = 2000;
  config.study.runs = 40;
  config.study.estimators = {{"likelihood", noise::Estimator::kDefault, white}};
  const EstimatorStudyOutcome outcome = estimator_study(config, Progress{});
  ASSERT_EQ(outcome.summaries.size(), 1U);
  double mean = 0.0;
  for (const noise::StudyFit& fit : outcome.result.fits.front()) mean += std::exp(fit.u.front()) / 40.0;
  EXPECT_NEAR(mean, 4.0, 4.0 * 4.0 * std::sqrt(2.0 / 2000.0 / 40.0));  // four sd of a mean of 40 variances
}

TEST(InMemory, ArrayStudyOfModelsHoldsItsIntervals) {
  ArrayStudyConfig config;
  config.kind = ArrayStudyKind::kModels;
  config.model.alpha = {0.5};
  config.samples = 2000;
  config.runs = 40;
  const ArrayStudyResult result = array_study(config, Progress{});
  const auto& study = std::get<noise::ArmaGarchStudy>(result);
  EXPECT_EQ(study.runs, 40U);
  EXPECT_GT(study.pooled_coverage, 0.85);  // 95 % of 80 intervals: three sd of the binomial are 7 %
}

TEST(InMemory, DiagnoseFindsTheLeverArmThatWasMoved) {
  DiagnosisConfig config;
  config.run = run_of(drive().scenario);
  config.run.setup.lever_arm_b.x() += 0.5;
  config.twins = 0;
  const DiagnosisResult result = diagnose(config, recordings_of(recording().mission), Progress{});
  const auto is_arm = [](const diagnose::Finding& f) { return f.hypothesis.effect->name == std::string("lever_arm_error"); };
  ASSERT_TRUE(std::ranges::any_of(result.diagnosis.findings, is_arm));
  const auto found = std::ranges::find_if(result.diagnosis.findings, is_arm);
  EXPECT_NEAR(std::abs(found->value), 0.5, 4.0 * found->sd + 0.02);
}

TEST(InMemory, CompareSeesADisplacement) {
  const record::Trajectory& truth = recording().mission.truth;
  record::Trajectory moved = truth;
  for (record::NavState& nav : moved.states)
    nav.r_eb_e += geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e)) * Eigen::Vector3d(1.0, 2.0, -3.0);
  const ComparisonResult result = compare(moved, truth, Eigen::Vector3d::Zero());
  EXPECT_EQ(result.differences.size(), result.summary.epochs);
  EXPECT_NEAR((result.summary.position.rms - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 0.0, 1e-6);
}

}  // namespace
}  // namespace coast::jobs
