// Fitted noise against the noise that was simulated: errors have the size that the fit says, each parameter with all others
// free.

#include "coast/estimate/noise_fit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "coast/noise/chi_square.hpp"
#include "estimate/mission.hpp"

namespace coast {
namespace {

using namespace estimate;

constexpr double kSd = 0.04, kTime = 3.0;
constexpr NoiseFitChoice kCorrelated{.gnss_scale = false, .correlated_gnss = true};

/// A mission whose fixes have a correlated error; what a fit of it needs.
class Wandering {
 public:
  Wandering(double duration, std::uint64_t seed)
      : seed_(seed), recording_(test::make_recording(options(duration), &model_, seed)) {}

  [[nodiscard]] NoiseFit fit() const {
    return fit_noise(recording_.mission(), model_, {}, kCorrelated, starting_point({}, kCorrelated),
                     [this](const ForwardFilter& filter) { return start(filter); });
  }
  [[nodiscard]] double log_likelihood(const NoiseAdjustment& adjustment) const {
    FilterOptions open;
    open.gate_probability = 0.0;
    const ForwardFilter filter(recording_.mission(), model_, adjusted(open, adjustment));
    return filter.run(start(filter), {}).log_likelihood;
  }

 private:
  [[nodiscard]] static test::RecordingOptions options(double duration) {
    test::RecordingOptions options{.duration = duration, .imu_rate_hz = 20.0};
    options.gnss.stated_sd = options.gnss.sd;
    options.gnss.correlated = {Eigen::Vector3d(kSd, kSd, kSd), kTime};
    return options;
  }
  [[nodiscard]] FilterState start(const ForwardFilter& filter) const {
    std::mt19937_64 random(seed_);
    return test::drawn_start(filter, recording_.truth(test::mission_start()), {}, random);
  }

  std::uint64_t seed_;
  noise::ImuErrorModel model_ = test::error_model(test::kIndustrialModel);
  test::Recording recording_;
};

TEST(NoiseFit, DeviationsAreThoseOfManySeeds) {
  constexpr int kSeeds = 12;
  double amplitude_squares = 0.0, time_squares = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const NoiseFit fit = Wandering(480.0, seed).fit();
    ASSERT_EQ(fit.names[0], "correlated_horizontal_m");
    ASSERT_EQ(fit.names[2], "correlated_time_s");
    const CorrelatedGnss& found = fit.adjustment.correlated_gnss;
    amplitude_squares += std::pow(std::log(found.horizontal_m / kSd) / fit.log_sd[0], 2);
    time_squares += std::pow(std::log(found.time_s / kTime) / fit.log_sd[2], 2);
  }
  // Two-sided 99.9 % of chi-square with a degree of freedom a seed.
  for (const double squares : {amplitude_squares, time_squares}) {
    EXPECT_GT(noise::chi2_survival(kSeeds, squares), 5e-4);
    EXPECT_LT(noise::chi2_survival(kSeeds, squares), 1.0 - 5e-4);
  }
}

// By passes of the filter alone, which the search shares no derivative with.
TEST(NoiseFit, EndsWhereNoNeighbourIsLikelier) {
  const Wandering mission(60.0, 1);
  const NoiseFit fit = mission.fit();
  const double highest = mission.log_likelihood(fit.adjustment);
  EXPECT_NEAR(highest, fit.log_likelihood_after, 1e-9 * std::abs(highest));  // the same sum
  EXPECT_GT(highest, fit.log_likelihood_before);
  const std::array<double CorrelatedGnss::*, 3> parameters = {&CorrelatedGnss::horizontal_m, &CorrelatedGnss::vertical_m,
                                                              &CorrelatedGnss::time_s};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    ASSERT_TRUE(std::isfinite(fit.log_sd[i]));
    for (const double step : {-0.2, 0.2}) {
      NoiseAdjustment neighbour = fit.adjustment;
      neighbour.correlated_gnss.*parameters[i] *= std::exp(step * fit.log_sd[i]);
      EXPECT_LT(mission.log_likelihood(neighbour), highest) << fit.names[i] << " " << step;
    }
  }
}

/// Everything free, on a mission with velocities; what is true is neither stated nor where a search begins.
class AllFree {
 public:
  static constexpr NoiseFitChoice kAll{.gnss_scale = true, .correlated_gnss = true, .imu_white_noise = true};
  static constexpr double kScale = 1.5;  ///< true sigmas over stated ones

  AllFree() : recording_(test::make_recording(options(), &model_, 21)) {}

  [[nodiscard]] test::Recording& recording() { return recording_; }
  [[nodiscard]] NoiseFit fit(const NoiseAdjustment& from, FitPrecision precision = FitPrecision::kOptimum) const {
    NoiseFitChoice choice = kAll;
    choice.precision = precision;
    return fit_noise(recording_.mission(), stated_, {}, choice, from, [this](const ForwardFilter& filter) {
      std::mt19937_64 random(4);
      return test::drawn_start(filter, recording_.truth(test::mission_start()), {}, random);
    });
  }
  [[nodiscard]] static std::vector<double> truth() {
    return {kScale, kScale, 1.0, 0.04, 0.06, 5.0, 1.0, 2.0, 3.0, 2.0, 4.0, 1.5};
  }
  [[nodiscard]] static std::vector<double> values(const NoiseAdjustment& a) {
    const GnssScale& scale = a.gnss_scale;
    const CorrelatedGnss& gnss = a.correlated_gnss;
    return {scale.horizontal,   scale.vertical,      scale.velocity,      gnss.horizontal_m,
            gnss.vertical_m,    gnss.time_s,         a.gyro_factors.x(),  a.gyro_factors.y(),
            a.gyro_factors.z(), a.accel_factors.x(), a.accel_factors.y(), a.accel_factors.z()};
  }

 private:
  [[nodiscard]] static test::RecordingOptions options() {
    test::RecordingOptions options{.duration = 300.0, .imu_rate_hz = 50.0};
    options.gnss.rate_hz = 4.0;
    options.gnss.sd = {0.015, 0.015, 0.03};
    options.gnss.stated_sd = options.gnss.sd / kScale;
    options.gnss.velocity_sd = Eigen::Vector3d(0.02, 0.02, 0.02);
    options.gnss.correlated = {Eigen::Vector3d(0.04, 0.04, 0.06), 5.0};
    return options;
  }

  noise::ImuErrorModel model_ = test::error_model(test::kIndustrialModel);
  noise::ImuErrorModel stated_ = model_.with_white_noise_scaled(noise::Sensor::kGyro, {1.0, 1.0 / 2.0, 1.0 / 3.0})
                                     .with_white_noise_scaled(noise::Sensor::kAccel, {1.0 / 2.0, 1.0 / 4.0, 1.0 / 1.5});
  test::Recording recording_;
};

void expect_same(const NoiseFit& a, const NoiseFit& b, double sigmas) {
  const std::vector<double> of_a = AllFree::values(a.adjustment), of_b = AllFree::values(b.adjustment);
  ASSERT_EQ(a.names.size(), of_a.size());
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const double log_sd = std::isfinite(a.log_sd[i]) ? a.log_sd[i] : 2.0;  // what is called unknown
    EXPECT_NEAR(std::log(of_a[i] / of_b[i]), 0.0, sigmas * log_sd) << a.names[i];
  }
}

// Each to a thousandth of a sigma, so any two to two.
TEST(NoiseFit, EndsAtTheSameOptimumFromAnyStart) {
  const AllFree mission;
  const NoiseFit first = mission.fit(starting_point({}, AllFree::kAll));
  const NoiseAdjustment far{.gnss_scale = {8.0, 0.2, 4.0},
                            .correlated_gnss = {.horizontal_m = 1.0, .vertical_m = 0.002, .time_s = 60.0},
                            .gyro_factors = {0.2, 0.1, 0.3},
                            .accel_factors = {15.0, 10.0, 20.0}};
  const NoiseAdjustment other{.gnss_scale = {0.1, 5.0, 0.3},
                              .correlated_gnss = {.horizontal_m = 0.003, .vertical_m = 0.5, .time_s = 1.5},
                              .gyro_factors = {10.0, 3.0, 10.0},
                              .accel_factors = {0.3, 0.3, 0.2}};
  for (const NoiseAdjustment& from : {far, other}) expect_same(first, mission.fit(from), 2e-3);
}

// What a search of effects compares is likelihoods; its thresholds are some units of their logarithm. A promised gain of a
// thousandth ends the fit: sqrt(0.002) sigmas along any direction. Passes: 24 and 58.
TEST(NoiseFit, ForASearchEndsNearTheOptimumInFewerPasses) {
  const AllFree mission;
  const NoiseAdjustment start = starting_point({}, AllFree::kAll);
  const NoiseFit exact = mission.fit(start), quick = mission.fit(start, FitPrecision::kSearch);
  expect_same(exact, quick, 0.05);
  EXPECT_NEAR(quick.log_likelihood_after, exact.log_likelihood_after, 0.01);
  EXPECT_LT(quick.evaluations, 0.7 * exact.evaluations);
  for (std::size_t i = 0; i < exact.log_sd.size(); ++i)
    if (std::isfinite(exact.log_sd[i])) {
      EXPECT_NEAR(quick.log_sd[i] / exact.log_sd[i], 1.0, 0.1) << exact.names[i];
    }
}

TEST(NoiseFit, FindsWhatWasSimulatedWithinItsSigmas) {
  const NoiseFit fit = AllFree().fit(starting_point({}, AllFree::kAll));
  const std::vector<double> found = AllFree::values(fit.adjustment), truth = AllFree::truth();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ASSERT_TRUE(std::isfinite(fit.log_sd[i])) << fit.names[i];
    EXPECT_LT(std::abs(std::log(found[i] / truth[i])), 3.7 * fit.log_sd[i]) << fit.names[i];  // eight values: 1 in 600
    EXPECT_EQ(fit.bounds[i], Bound::kNone) << fit.names[i];
  }
}

// As if they had never been there.
TEST(NoiseFit, LeavesOutWhatTheGateRefuses) {
  AllFree with, without;
  std::vector<record::GnssFix>& fixes = without.recording().gnss.fixes;
  for (const int bad : {900, 501, 500, 200}) {
    with.recording().gnss.fixes[static_cast<std::size_t>(bad)].r_ea_e += Eigen::Vector3d(0.0, 4.0, 3.0);
    fixes.erase(fixes.begin() + bad);
  }
  const NoiseAdjustment from = starting_point({}, AllFree::kAll);
  expect_same(without.fit(from), with.fit(from), 2e-3);
}

// Smoothed by the receiver, fixes have a correlated error alone.
TEST(NoiseFit, TellsWhichParametersEndOnABound) {
  test::RecordingOptions options{.duration = 200.0, .imu_rate_hz = 50.0};
  options.gnss.rate_hz = 5.0;
  options.gnss.sd = Eigen::Vector3d::Constant(1e-5);
  options.gnss.stated_sd = Eigen::Vector3d::Constant(0.02);
  options.gnss.correlated = {Eigen::Vector3d::Constant(0.02), 4.0};
  const noise::ImuErrorModel model = test::error_model(test::kIndustrialModel);
  const test::Recording recording = test::make_recording(options, &model, 3);
  constexpr NoiseFitChoice kGnss{.gnss_scale = true, .correlated_gnss = true};
  const NoiseFit fit =
      fit_noise(recording.mission(), model, {}, kGnss, starting_point({}, kGnss), [&](const ForwardFilter& filter) {
        std::mt19937_64 random(3);
        return test::drawn_start(filter, recording.truth(test::mission_start()), {}, random);
      });
  ASSERT_EQ(fit.bounds.size(), 5U);
  EXPECT_EQ(fit.bounds[0], Bound::kLower);
  EXPECT_NEAR(fit.adjustment.gnss_scale.horizontal, 0.005, 1e-8);
  // A white noise of a few hundredths of the stated one may be found by chance.
  EXPECT_EQ(fit.bounds[1] == Bound::kLower, fit.adjustment.gnss_scale.vertical < 0.005 + 1e-8);
  EXPECT_LT(fit.adjustment.gnss_scale.vertical, 0.1);
  for (std::size_t i = 2; i < 5; ++i) EXPECT_EQ(fit.bounds[i], Bound::kNone) << fit.names[i];
}

// Known drifts count from the first epoch, restarts lie on the way: the likelihood is the mission's own.
TEST(NoiseFit, KeepsAllOfTheMission) {
  const noise::ImuErrorModel model = test::error_model(R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.2, unit: deg/sqrt(h)}, {process: random_constant, sigma: 30, unit: deg/h},
        {process: drift, slope: 200, unit: deg/h/h}]
accel:
  all: [{process: white_noise, density: 80, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 2, unit: mg}]
)");
  test::RecordingOptions options{.duration = 120.0, .imu_rate_hz = 50.0};
  const test::Recording recording = test::make_recording(options, &model, 9);
  Mission mission = recording.mission();
  mission.first_epoch = test::mission_start() - 1800.0;
  mission.restarts = {{recording.truth(test::mission_start() + 60.0), Eigen::Vector3d::Constant(0.1),
                       Eigen::Vector3d::Constant(0.1), Eigen::Vector3d(2e-3, 2e-3, 5e-3)}};
  const auto start = [&](const ForwardFilter& filter) {
    return filter.initial_state(recording.truth(test::mission_start()), Eigen::Vector3d::Constant(0.1),
                                Eigen::Vector3d::Constant(0.05), Eigen::Vector3d(2e-3, 2e-3, 5e-3));
  };
  constexpr NoiseFitChoice kScaleAlone{.gnss_scale = true, .correlated_gnss = false};
  const NoiseFit fit = fit_noise(mission, model, {}, kScaleAlone, {}, start);
  const auto log_likelihood = [&](const Mission& of) {
    FilterOptions open;
    open.gate_probability = 0.0;
    const ForwardFilter filter(of, model, adjusted(open, fit.adjustment));
    return filter.run(start(filter), {}).log_likelihood;
  };
  const double own = log_likelihood(mission);
  EXPECT_NEAR(fit.log_likelihood_after, own, 1e-9 * std::abs(own));
  Mission without_epoch = mission, without_restart = mission;
  without_epoch.first_epoch.reset();
  without_restart.restarts.clear();
  EXPECT_GT(std::abs(log_likelihood(without_epoch) - own), 0.1);  // they matter
  EXPECT_GT(std::abs(log_likelihood(without_restart) - own), 0.1);
}

}  // namespace
}  // namespace coast
