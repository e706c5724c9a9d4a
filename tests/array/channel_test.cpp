#include "coast/array/channel.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "array/noisy_array.hpp"

namespace coast::array {
namespace {

using test::noisy_array;

TEST(OwnVariances, SolveTheEquationsOfAnyArray) {
  // Residual variances written out from the covariance matrix of z - mean(z), which shares nothing with the solution.
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(0.5, 4.0);
  for (int K = 3; K <= 8; ++K) {
    Eigen::VectorXd sigma2(K);
    for (double& s : sigma2) s = uniform(generator);
    const Eigen::MatrixXd M = Eigen::MatrixXd::Identity(K, K) - Eigen::MatrixXd::Constant(K, K, 1.0 / K);
    const Eigen::VectorXd v = (M * sigma2.asDiagonal() * M.transpose()).diagonal();
    const std::vector<double> own = own_variances(std::vector<double>(v.begin(), v.end()));
    for (int k = 0; k < K; ++k) EXPECT_NEAR(own[static_cast<std::size_t>(k)], sigma2(k), 1e-12) << K;
  }
}

TEST(OwnVariances, OfTwoShareTheSum) {
  const std::vector<double> own = own_variances(std::vector<double>{0.75, 0.75});  // (1 + 2) / 4 each
  EXPECT_DOUBLE_EQ(own[0], 1.5);
  EXPECT_DOUBLE_EQ(own[1], 1.5);
  EXPECT_THROW(static_cast<void>(own_variances(std::vector<double>{1.0})), std::invalid_argument);
}

TEST(OwnVariances, AreNeverNegative) {
  for (const double own : own_variances(std::vector<double>{1.0, 1.0, 0.1})) EXPECT_GT(own, 0.0);
}

TEST(RelativeOffsets, AreFoundWhereSensorsComeAndGo) {
  Signals signals = noisy_array({0.01, 0.02, 0.01, 0.03}, 20000, 7);
  const Eigen::Vector4d bias(0.3, -0.5, 0.1, 0.1);
  for (std::size_t k = 0; k < 4; ++k) signals.sensors[k].values.array() += bias(static_cast<Eigen::Index>(k));
  for (std::size_t n = 3000; n < 9000; ++n) signals.sensors[1].usable[n] = 0;  // the second is away for a while
  const auto offsets = take_off_relative_offsets(signals, 20.0);
  for (std::size_t k = 0; k < 4; ++k)
    for (Eigen::Index window = 4; window < offsets[k].cols(); ++window)  // after it has come back
      for (int c = 0; c < kChannels; ++c)
        // Mean of 2000 samples of 0.03 at most: 7e-4; 240 of them, none beyond 4.5 sigma.
        EXPECT_NEAR(offsets[k](c, window), bias(static_cast<Eigen::Index>(k)) - bias.mean(), 3e-3);
  // Its absence does not shift the mean of the others: they keep their places.
  const Eigen::MatrixXd y = residuals(signals, 0);
  EXPECT_NEAR(y.row(0).segment(4000, 4000).mean(), 0.0, 3e-3);
  EXPECT_EQ(y.row(1).segment(4000, 4000).cwiseAbs().maxCoeff(), 0.0);
}

TEST(NoiseOverTime, FollowsEachSensorsOwn) {
  Signals signals = noisy_array({0.01, 0.02, 0.01, 0.04}, 60000, 8);
  signals.sensors[2].values.rightCols(30000) *= 3.0;  // louder from the middle on; the motion is zero
  const NoiseOverTime noise = noise_over_time(signals, 4, 10.0);
  ASSERT_EQ(noise.variance.cols(), 60);
  const Eigen::MatrixXd sd = noise.variance.cwiseSqrt();
  // A block of 1000 samples knows a variance to sqrt(2/1000) = 4.5 %; solved for, of the small beside the large, to
  // (0.04/0.01)^2/16 times as much more. Thirty blocks: sd of the mean below 2 %.
  EXPECT_NEAR(sd.row(0).mean(), 0.01, 0.0006);
  EXPECT_NEAR(sd.row(1).mean(), 0.02, 0.0004);
  EXPECT_NEAR(sd.row(2).head(30).mean(), 0.01, 0.0006);
  EXPECT_NEAR(sd.row(2).tail(30).mean(), 0.03, 0.0006);
  EXPECT_NEAR(sd.row(3).mean(), 0.04, 0.0008);
}

TEST(NoiseOverTime, OfASensorThatIsMissingWhileAllAreShakenIsTheirs) {
  Signals signals = noisy_array({0.01, 0.02, 0.01, 0.02}, 60000, 9);
  for (SensorSignals& sensor : signals.sensors) sensor.values.rightCols(30000) *= 5.0;
  std::fill(signals.sensors[1].usable.begin() + 30000, signals.sensors[1].usable.end(), std::uint8_t{0});
  const NoiseOverTime noise = noise_over_time(signals, 2, 10.0);
  // As above: thirty blocks know a mean to 2 %, of which the size and the level each take part.
  EXPECT_NEAR(std::sqrt(noise.variance.row(1).tail(30).mean()), 0.1, 0.006);
  EXPECT_NEAR(std::sqrt(noise.variance.row(1).head(30).mean()), 0.02, 0.0004);
}

}  // namespace
}  // namespace coast::array
