// Fitted noise against the noise that was simulated: errors have the size that the fit says, each parameter with all others
// free.

#include "coast/estimate/noise_fit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

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

}  // namespace
}  // namespace coast
