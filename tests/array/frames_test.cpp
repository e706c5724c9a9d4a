#include "coast/array/frames.hpp"

#include <gtest/gtest.h>

#include "array/analytic_array.hpp"

namespace coast::array {
namespace {

using test::add_white_noise;
using test::analytic_array;
using test::four_frames;
using test::PlatformMotion;

constexpr double kFrameDt = 0.01;

TEST(Differentiator, IsExactForPolynomialsOfFourthDegree) {
  // A Savitzky-Golay fit of degree 4 gives back any polynomial of degree 4, also where it is read off beside the middle.
  for (const int m : {2, 5, 12}) {
    const Differentiator d(m, kFrameDt);
    Eigen::Matrix3Xd x(3, 40), slope(3, 40);
    for (int n = 0; n < 40; ++n) {
      const double t = n * kFrameDt;
      x.col(n) << 1.0 + 2.0 * t, t * t * t, 3.0 * t * t * t * t;
      slope.col(n) << 2.0, 3.0 * t * t, 12.0 * t * t * t;
    }
    EXPECT_LT((d.apply(x) - slope).cwiseAbs().maxCoeff(), 1e-9) << m;  // rounding times the gain, 1e-16 x 0.1 / dt^... < 1e-9
  }
}

TEST(Differentiator, NarrowestIsTheFivePointFormula) {
  const Eigen::RowVectorXd row = Differentiator(2, kFrameDt).coefficients() * kFrameDt;
  const Eigen::RowVectorXd five = (Eigen::RowVectorXd(5) << 1.0, -8.0, 0.0, 8.0, -1.0).finished() / 12.0;
  EXPECT_LT((row - five).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Differentiator, StatesItsNoiseAndItsResponse) {
  const Differentiator d(6, kFrameDt);
  // Response: of the derivative found of a sine, by applying it to one.
  const double f = 3.0, w = 2.0 * M_PI * f;
  Eigen::Matrix3Xd sine = Eigen::Matrix3Xd::Zero(3, 101);
  for (int n = 0; n < 101; ++n) sine(0, n) = std::sin(w * (n - 50) * kFrameDt);
  EXPECT_NEAR(d.apply(sine)(0, 50) / w, d.response(f), 1e-12);
  EXPECT_LT(d.response(f), 1.0);
  // Noise: 1e5 samples know a standard deviation to 1 / sqrt(2 n / correlation) < 0.8 %; four of these.
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  Eigen::Matrix3Xd noise(3, 100000);
  for (double& x : noise.reshaped()) x = normal(generator);
  const double sd = std::sqrt(d.apply(noise).squaredNorm() / 3e5);
  EXPECT_NEAR(sd / d.noise_gain(), 1.0, 0.03);
}

// Stebler et al. (2011), Eqs. (4) and (5), without noise and at high dynamics: what is left is the differentiator's lost
// motion.
TEST(Frames, FourSensorsAgreeInTheBodyFrame) {
  const PlatformMotion motion{.rate = 6.0, .force = 20.0, .frequency = 1.0};
  const std::vector<SensorFrame> frames = four_frames();
  Signals signals = analytic_array(motion, frames, kFrameDt, 2000);
  turn_to_body(signals, frames);
  for (const SensorSignals& sensor : signals.sensors)
    EXPECT_LT((sensor.values.topRows<3>() - signals.sensors[0].values.topRows<3>()).cwiseAbs().maxCoeff(), 1e-12);
  const AngularMotion found = angular_motion(signals);
  EXPECT_EQ(found.half_width, 2);  // nothing to smooth
  move_to_origin(signals, frames, found);
  // The five-point formula loses 1/30 (w dt)^4 of a sine; its mean over an interval is exact. Largest lever arm 0.13 m; the
  // centripetal term's mean is right to fourth order in dt.
  double lost = 0.0;
  for (const double factor : {1.0, 1.618, 2.7}) {
    const double w = 2.0 * M_PI * motion.frequency * factor;
    lost += motion.rate / 3.0 * w * std::pow(w * kFrameDt, 4) / 30.0;
  }
  const double stated = 1.1 * std::sqrt(3.0) * lost * 0.13 + 1e-6;
  for (std::size_t n = 3; n + 3 < signals.samples(); ++n) {
    const double from = static_cast<double>(n) * kFrameDt;
    const Eigen::Vector3d truth = test::mean_over(from, from + kFrameDt, [&](double t) { return motion.f(t); });
    for (const SensorSignals& sensor : signals.sensors)
      ASSERT_LT((sensor.values.col(static_cast<Eigen::Index>(n)).tail<3>() - truth).norm(), stated) << sensor.name << n;
  }
  EXPECT_LT(stated, 0.012);  // m/s^2, of 60 m/s^2 that the lever arms make
}

TEST(Frames, SizeEffectIsLeftInWhereTheLeverArmIsNotKnown) {
  const std::vector<SensorFrame> frames = four_frames();
  Signals signals = analytic_array({}, frames, kFrameDt, 500);
  turn_to_body(signals, frames);
  EXPECT_GT((signals.sensors[1].values - signals.sensors[0].values).bottomRows<3>().cwiseAbs().maxCoeff(), 1.0);
}

TEST(Frames, WidthFollowsTheNoise) {
  const PlatformMotion motion{.rate = 2.0, .force = 5.0, .frequency = 0.5};
  const std::vector<SensorFrame> frames(4);
  int before = 2;
  for (const double sd : {1e-4, 1e-2, 0.1}) {
    Signals signals = analytic_array(motion, frames, kFrameDt, 6000);
    add_white_noise(signals, sd, 0.0, 5);
    const AngularMotion found = angular_motion(signals);
    EXPECT_NEAR(found.noise_sd, sd / 2.0, 0.03 * sd) << "mean of four";
    EXPECT_GE(found.half_width, before);
    before = found.half_width;
    double squares = 0.0;
    for (std::size_t n = 0; n < signals.samples(); ++n) {
      const double from = static_cast<double>(n) * kFrameDt;
      const Eigen::Vector3d truth = test::mean_over(from, from + kFrameDt, [&](double t) { return motion.alpha(t); });
      squares += (found.alpha.col(static_cast<Eigen::Index>(n)) - truth).squaredNorm();
    }
    const double error = std::sqrt(squares / 3.0 / static_cast<double>(signals.samples()));
    // The stated error is an estimate from the same rates; it takes lost motion to grow with the fourth power of the width,
    // which is too fast for the fastest of the sines: up to a half too large.
    EXPECT_GT(found.error_sd / error, 0.8) << sd;
    EXPECT_LT(found.error_sd / error, 1.6) << sd;
    EXPECT_LT(error, sd / 2.0 * Differentiator(2, kFrameDt).noise_gain()) << "not better than the narrowest";
  }
  EXPECT_GT(before, 8);
}

}  // namespace
}  // namespace coast::array
