#include "coast/array/synthetic.hpp"

#include <gtest/gtest.h>

#include "array/noisy_array.hpp"
#include "coast/noise/arma_garch.hpp"

namespace coast::array {
namespace {

using test::noisy_array;

constexpr std::size_t kMergeSamples = 30000;

/// Motion that all sensors feel alike.
Eigen::VectorXd common_motion() {
  return Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(kMergeSamples), 0.0, 100.0).array().sin();
}

void add_motion(Signals& signals, const Eigen::VectorXd& motion) {
  for (SensorSignals& sensor : signals.sensors) sensor.values.rowwise() += motion.transpose();
}

double mean_square(const Eigen::VectorXd& x) {
  return x.squaredNorm() / static_cast<double>(x.size());
}

/// Four sensors whose errors follow ARMA-GARCH models of their own.
Signals arma_garch_array(std::uint64_t seed) {
  Signals signals = noisy_array({1.0, 1.0, 1.0, 1.0}, kMergeSamples, 1);
  const std::vector<double> level{1.0, 2.0, 0.5, 3.0};
  for (std::size_t k = 0; k < 4; ++k) {
    const noise::ArmaGarch model{.alpha = {0.7}, .beta = {}, .gamma0 = 1e-4 * level[k], .gamma = {0.2}, .delta = {0.75}};
    std::mt19937_64 generator(seed + k);
    const std::vector<double> y = noise::simulate_arma_garch(model, kMergeSamples, generator);
    signals.sensors[k].values.row(0) = Eigen::Map<const Eigen::RowVectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
  }
  return signals;
}

TEST(Merge, OfLikeSensorsFallsWithTheRootOfTheirNumber) {
  for (const std::size_t K : {2U, 3U, 5U}) {
    const Signals signals = noisy_array(std::vector<double>(K, 0.1), kMergeSamples, K);
    for (const Merge merge : {Merge::kMean, Merge::kWeighted}) {
      const MergedChannel merged = merge_channel(signals, 2, {.merge = merge});
      // 30000 samples know a variance to 0.8 %.
      EXPECT_NEAR(mean_square(merged.value) / (0.01 / static_cast<double>(K)), 1.0, 0.03) << K;
      EXPECT_NEAR(merged.variance.mean() / (0.01 / static_cast<double>(K)), 1.0, 0.03) << K << " as stated";
    }
  }
}

TEST(Merge, ByInverseVariancesIsTheBestOfUnlikeSensors) {
  const std::vector<double> sd{0.1, 0.2, 0.1, 0.4};
  Signals signals = noisy_array(sd, kMergeSamples, 3);
  const Eigen::VectorXd motion = common_motion();
  add_motion(signals, motion);
  double precision = 0.0, plain = 0.0;
  for (const double s : sd) precision += 1.0 / (s * s), plain += s * s / 16.0;
  const MergedChannel mean = merge_channel(signals, 0, {.merge = Merge::kMean});
  const MergedChannel weighted = merge_channel(signals, 0, {.merge = Merge::kWeighted});
  EXPECT_NEAR(mean_square(mean.value - motion) / plain, 1.0, 0.03);
  EXPECT_NEAR(mean_square(weighted.value - motion) * precision, 1.0, 0.03);
  for (Eigen::Index k = 0; k < 4; ++k)
    EXPECT_NEAR(weighted.weight(k), 1.0 / (sd[static_cast<std::size_t>(k)] * sd[static_cast<std::size_t>(k)] * precision),
                0.02);
}

TEST(Merge, LeavesOutWhoMayNotBeUsed) {
  Signals signals = noisy_array({0.1, 0.1, 0.1}, kMergeSamples, 4);
  for (std::size_t n = 10000; n < 20000; ++n) {
    signals.sensors[1].usable[n] = 0x3E;  // its first channel
    signals.sensors[1].values(0, static_cast<Eigen::Index>(n)) = 1e6;
  }
  for (const Merge merge : {Merge::kMean, Merge::kWeighted, Merge::kGarch, Merge::kCorrected}) {
    const MergedChannel merged = merge_channel(signals, 0, {.merge = merge, .orders = {1, 0, 1, 1}});
    EXPECT_LT(merged.value.cwiseAbs().maxCoeff(), 0.5);
    EXPECT_NEAR(mean_square(merged.value.segment(10000, 10000)) / (0.01 / 2.0), 1.0, 0.06);
    EXPECT_NEAR(mean_square(merged.value.head(10000)) / (0.01 / 3.0), 1.0, 0.06);
  }
}

// With the sensors' true errors at hand (a reference) the ARMA part is predictable and comes off, the GARCH part tells the
// weights: nothing does better than knowing the models and the variances.
TEST(Merge, CorrectedByTheErrorsThemselvesReachesTheOracle) {
  Signals signals = arma_garch_array(11);
  const Eigen::VectorXd motion = common_motion();
  add_motion(signals, motion);
  double precision = 0.0;
  for (const double level : {1.0, 2.0, 0.5, 3.0}) precision += 1.0 / (1e-4 * level / 0.05);
  const MergeOptions corrected{.merge = Merge::kCorrected, .orders = {1, 0, 1, 1}};
  const MergedChannel with_reference = merge_channel(signals, 0, corrected, motion);
  const double reached = mean_square(with_reference.value - motion);
  EXPECT_LT(reached, 1.02 / precision) << "fixed weights for innovations; changing ones must not be worse";
  EXPECT_NEAR(with_reference.variance.mean() / reached, 1.0, 0.1);
  const MergedChannel fixed = merge_channel(signals, 0, {.merge = Merge::kWeighted});
  EXPECT_GT(mean_square(fixed.value - motion), 1.5 * reached) << "an AR(1) of 0.7 doubles the variance";
}

// By residuals alone only what the sensors do not have in common is seen: of like sensors at equal weights the predictions add
// up to nothing.
TEST(Merge, CorrectedByResidualsIsBetterThanTheMeanAndWorseThanByErrors) {
  Signals signals = arma_garch_array(12);
  const MergeOptions corrected{.merge = Merge::kCorrected, .orders = {1, 0, 1, 1}};
  const double by_residuals = mean_square(merge_channel(signals, 0, corrected).value);
  const double by_errors = mean_square(
      merge_channel(signals, 0, corrected, Eigen::VectorXd(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kMergeSamples))))
          .value);
  const double plain = mean_square(merge_channel(signals, 0, {.merge = Merge::kMean}).value);
  EXPECT_LT(by_residuals, 0.9 * plain);
  EXPECT_LT(by_errors, by_residuals);
}

TEST(Merge, ShareOfDensityIsThatOfSlowMeans) {
  const Signals signals = arma_garch_array(13);
  // Means over a second see the density at frequency zero. 300 of them know a variance to 8 %, of both merges alike.
  const auto slow = [](const Eigen::VectorXd& x) {
    const Eigen::Index blocks = x.size() / 100;
    return mean_square(x.head(100 * blocks).reshaped(100, blocks).colwise().mean().transpose());
  };
  const MergedChannel mean = merge_channel(signals, 0, {.merge = Merge::kMean});
  EXPECT_NEAR(white_share(mean), 1.0, 1e-9);
  for (const Merge merge : {Merge::kWeighted, Merge::kGarch}) {
    const MergedChannel merged = merge_channel(signals, 0, {.merge = merge, .orders = {1, 0, 1, 1}});
    EXPECT_NEAR(white_share(merged) / (slow(merged.value) / slow(mean.value)), 1.0, 0.25);
  }
}

TEST(Merge, WithoutNoiseIsTheMotion) {
  Signals signals = noisy_array({0.0, 0.0, 0.0}, 2000, 5);
  for (SensorSignals& sensor : signals.sensors) sensor.values.row(3).setLinSpaced(0.0, 1.0);
  for (const Merge merge : {Merge::kMean, Merge::kWeighted, Merge::kGarch, Merge::kCorrected}) {
    const MergedChannel merged = merge_channel(signals, 3, {.merge = merge});
    EXPECT_NEAR(merged.value(1000), 1000.0 / 1999.0, 1e-12);
    EXPECT_TRUE(merged.value.allFinite() && merged.variance.allFinite());
  }
}

TEST(Merge, RefusesWhatItCannotUse) {
  EXPECT_THROW(static_cast<void>(merge_channel(noisy_array({1.0}, 100, 1), 0, {})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(merge_channel(noisy_array({1.0, 1.0}, 100, 1), 0, {}, Eigen::VectorXd::Zero(99))),
               std::invalid_argument);
}

}  // namespace
}  // namespace coast::array
