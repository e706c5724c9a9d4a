// Outages that branch off from one run, against runs of the whole mission that never have their fixes.

#include "coast/study/outage_runs.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

#include "simulated.hpp"

namespace coast::study {
namespace {

/// An IMU that drifts tens of metres in a minute: what the linearisation of the future would spoil, it spoils here.
constexpr const char* kConsumerModel = R"(
schema: coast.imu_error_model/1
sensor: consumer
gyro:
  all: [{process: white_noise, density: 2, unit: deg/sqrt(h)}, {process: random_constant, sigma: 1000, unit: deg/h},
        {process: gauss_markov, sigma: 50, unit: deg/h, correlation_time_s: 100}, {process: scale_factor, sigma: 5000, unit: ppm}]
accel:
  all: [{process: white_noise, density: 500, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 30, unit: mg},
        {process: gauss_markov, sigma: 1, unit: mg, correlation_time_s: 100}, {process: scale_factor, sigma: 5000, unit: ppm}]
)";

/// A city drive, filtered once without gaps.
struct Drive {
  record::Trajectory truth;
  std::unique_ptr<PreparedMission> mission;
  estimate::KnotStore knots;

  explicit Drive(double duration_s, const noise::ImuErrorModel* model = nullptr, const estimate::FilterOptions& filter = {}) {
    simulate::Scenario scenario = test::drive(duration_s, 3);
    scenario.gnss.rate_hz = 2.0;
    if (model != nullptr) scenario.error_model = *model;
    simulate::SimulatedMission recording = simulate::simulate(scenario);
    truth = std::move(recording.truth);
    Setup setup = test::setup_of(scenario);
    setup.filter = filter;
    mission =
        std::make_unique<PreparedMission>(std::move(recording.imu), std::move(recording.gnss), std::move(setup), Progress{});
    knots = gap_free_knots(*mission, {});
  }
  [[nodiscard]] geo::GpsTime begin() const { return mission->start().nav.t; }
  [[nodiscard]] geo::GpsTime end() const { return mission->mission().imu.samples.back().t; }
  /// Somewhere, 1 s to 60 s long, none within 10 s of the start or the end.
  [[nodiscard]] std::vector<Outage> drawn(int count, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> fraction(0.0, 1.0);
    std::vector<Outage> outages;
    for (int i = 0; i < count; ++i) {
      const double duration = 1.0 + 59.0 * fraction(random);
      outages.push_back({begin() + 10.0 + fraction(random) * (end() - begin() - 20.0 - duration), duration});
    }
    return outages;
  }
};

constexpr double kOfDrift = 0.01;  // what a shared run may differ by from one of the whole mission, by the specification

void expect_same(const OutageErrors& shared, const OutageErrors& whole, const char* solution, double start_s) {
  EXPECT_NEAR(shared.horizontal_max_m, whole.horizontal_max_m, kOfDrift * whole.horizontal_max_m) << solution << start_s;
  EXPECT_NEAR(shared.sigma_max_m.norm(), whole.sigma_max_m.norm(), kOfDrift * whole.sigma_max_m.norm()) << solution << start_s;
  EXPECT_EQ(shared.tested, whole.tested) << solution << start_s;
}

void expect_equal_to_whole_runs(const Drive& drive, const std::vector<Outage>& outages) {
  const Truth truth{drive.truth};
  const std::vector<OutageResult> shared = run_outages(*drive.mission, drive.knots, truth, outages);
  ASSERT_EQ(shared.size(), outages.size());
  for (std::size_t i = 0; i < outages.size(); ++i) {
    const double start_s = outages[i].start - drive.begin();
    const OutageResult whole = run_outage_whole(*drive.mission, truth, outages[i]);
    EXPECT_EQ(shared[i].outage.start, outages[i].start);
    EXPECT_EQ(shared[i].manoeuvre, whole.manoeuvre) << start_s;
    expect_same(shared[i].forward, whole.forward, "forward ", start_s);
    expect_same(*shared[i].smoothed, *whole.smoothed, "smoothed ", start_s);
  }
}

TEST(OutageRuns, EqualRunsOfTheWholeMission) {
  const Drive drive(600.0);
  std::vector<Outage> outages = drive.drawn(20, 20);
  outages.push_back({drive.end() - 30.0, 30.0});    // the recording ends in it
  outages.push_back({drive.end() - 30.0, 25.0});    // and before the filter has settled
  outages.push_back({drive.begin() + 0.25, 20.0});  // the first knot is the start
  expect_equal_to_whole_runs(drive, outages);
}

TEST(OutageRuns, EqualThemWhereErrorsAreLarge) {
  const noise::ImuErrorModel model = noise::ImuErrorModel::from(io::parse_yaml(kConsumerModel, "model.yaml"));
  const Drive drive(340.0, &model);
  std::vector<Outage> outages = drive.drawn(6, 21);
  outages.push_back({drive.begin() + 5.0, 20.0});
  expect_equal_to_whole_runs(drive, outages);
}

// States of the antenna and of GNSS, and constraints that go on through the outage.
TEST(OutageRuns, EqualThemWithAuxiliaryStatesAndConstraints) {
  const noise::ImuErrorModel model = noise::ImuErrorModel::from(io::parse_yaml(kConsumerModel, "model.yaml"));
  estimate::FilterOptions options;
  options.auxiliary.lever_arm_sd_m = 0.05;
  options.auxiliary.time_offset_sd_s = 0.01;
  options.auxiliary.correlated_gnss = {.horizontal_m = 0.02, .vertical_m = 0.03, .time_s = 60.0};
  options.vehicle.non_holonomic = estimate::NonHolonomic{};
  options.vehicle.zero_velocity_sd_mps = 0.02;
  const Drive drive(340.0, &model, options);
  expect_equal_to_whole_runs(drive, drive.drawn(6, 22));
}

TEST(OutageRuns, AreTheSameForAnyNumberOfThreadsAndSunkOnce) {
  const Drive drive(340.0);
  std::vector<Outage> outages = drive.drawn(5, 23);
  for (Outage& outage : outages) outage.duration_s = std::min(outage.duration_s, 20.0);
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<int> sunk(outages.size());
    std::vector<double> at_sink(outages.size());
    const auto results =
        run_outages(*drive.mission, drive.knots, {drive.truth}, outages, [&](std::size_t i, const OutageResult& result) {
          ++sunk[i];
          at_sink[i] = result.smoothed->horizontal_max_m;
        });
    EXPECT_EQ(sunk, std::vector<int>(outages.size(), 1));
    std::vector<double> numbers;
    for (std::size_t i = 0; i < results.size(); ++i) {
      EXPECT_EQ(results[i].smoothed->horizontal_max_m, at_sink[i]);
      for (const OutageErrors* errors : {&results[i].forward, &*results[i].smoothed})
        for (const auto& v : {errors->max_m, errors->rms_m, errors->end_m, errors->sigma_end_m, errors->attitude_max})
          numbers.insert(numbers.end(), v.begin(), v.end());
    }
    return numbers;
  };
  EXPECT_EQ(with_threads(1), with_threads(3));
}

// Neither the fix at its beginning nor, where fixes are tagged late, the ones that are valid before it.
TEST(OutageRuns, BeginWithAStartThatHasNotSeenWhatTheyWithhold) {
  simulate::Scenario scenario = test::drive(340.0, 3);
  scenario.gnss.time_offset = 0.3;
  const geo::GpsTime outage = scenario.start + 130.0;
  const simulate::SimulatedMission recording = simulate::simulate(scenario);
  const auto start = [&](double moved_m) {
    record::GnssRecording gnss = recording.gnss;
    for (record::GnssFix& fix : gnss.fixes)
      if (fix.t >= outage) fix.r_ea_e.x() += moved_m;
    study::Setup setup = test::setup_of(scenario);
    setup.time_offset_s = scenario.gnss.time_offset;
    setup.refine_before = outage;
    return PreparedMission(recording.imu, std::move(gnss), std::move(setup), {}).start().nav;
  };
  const record::NavState seen = start(0.0);
  const record::NavState moved = start(10.0);
  // The start is refined until it rests to 1e-8 rad; the alignment that it began with may have looked further. One such fix
  // more turns it by 5e-6 rad.
  EXPECT_LE(estimate::error_between(seen, moved).segment<3>(estimate::kPsi).norm(), 1e-6);
}

}  // namespace
}  // namespace coast::study
