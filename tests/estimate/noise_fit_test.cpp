// Fitted noise against the noise that was simulated: errors have the size that the fit says, each parameter with all others
// free.

#include "coast/estimate/noise_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coast/noise/chi_square.hpp"
#include "estimate/mission.hpp"

namespace coast {
namespace {

using namespace estimate;

TEST(NoiseFit, DeviationsAreThoseOfManySeeds) {
  constexpr int kSeeds = 12;
  constexpr double kSd = 0.04, kTime = 3.0;
  const noise::ImuErrorModel model = test::error_model(test::kIndustrialModel);
  double amplitude_squares = 0.0, time_squares = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    test::RecordingOptions options{.duration = 480.0, .imu_rate_hz = 20.0};
    options.gnss.stated_sd = options.gnss.sd;
    options.gnss.correlated = {Eigen::Vector3d(kSd, kSd, kSd), kTime};
    const test::Recording recording = test::make_recording(options, &model, seed);
    const Mission mission = recording.mission();
    const auto start = [&](const ForwardFilter& filter) {
      std::mt19937_64 random(seed);
      return test::drawn_start(filter, recording.truth(test::mission_start()), {}, random);
    };
    const NoiseFitChoice choice{.gnss_scale = false, .correlated_gnss = true};
    const NoiseFit fit = fit_noise(mission, model, {}, choice, starting_point({}, choice), start);
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

}  // namespace
}  // namespace coast
