#include "coast/study/drift.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace coast::study {
namespace {

OutageResult one_outage(const Eigen::Vector3d& end, double horizontal, std::size_t inside) {
  OutageErrors errors;
  errors.end_m = end;
  errors.max_m = 2.0 * end.cwiseAbs();
  errors.sigma_end_m = Eigen::Vector3d(3.0, 4.0, 5.0);
  errors.sigma_max_m = horizontal * Eigen::Vector3d(1.0, 2.0, 3.0);
  errors.horizontal_max_m = horizontal;
  errors.inside_95 = inside;
  errors.tested = 10;
  return {{geo::GpsTime(), 20.0}, errors, errors};
}

TEST(Drift, ByHand) {
  std::vector<OutageResult> outages{one_outage({3.0, -1.0, 0.0}, 5.0, 10), one_outage({-4.0, 1.0, 2.0}, 7.0, 8)};
  const Drift d = drift_of(outages, true);
  EXPECT_NEAR(d.end[0].rms, std::sqrt(12.5), 1e-14);
  EXPECT_NEAR(d.end[0].median, 3.5, 1e-14);
  EXPECT_NEAR(d.end[1].rms, 1.0, 1e-14);
  EXPECT_NEAR(d.largest[2].rms, std::sqrt(8.0), 1e-14);
  EXPECT_NEAR(d.horizontal.median, 6.0, 1e-14);
  EXPECT_NEAR(d.horizontal.p95, 6.9, 1e-14);
  EXPECT_NEAR(d.horizontal.p68, 6.36, 1e-14);
  EXPECT_EQ(d.horizontal.max, 7.0);
  EXPECT_NEAR(d.horizontal.rms, std::sqrt(37.0), 1e-14);
  EXPECT_NEAR(d.predicted_end_rms_m.y(), 4.0, 1e-14);
  EXPECT_NEAR(d.predicted_largest_rms_m.z(), 3.0 * std::sqrt(37.0), 1e-13);
  EXPECT_NEAR(d.inside_95, 0.9, 1e-14);
  EXPECT_EQ(drifts(outages, DriftMeasure::kNorth, false), (std::vector<double>{6.0, 8.0}));
}

TEST(Drift, AgainstFixesIsOfOutagesThatHaveThem) {
  std::vector<OutageResult> outages{one_outage({3.0, -1.0, 0.0}, 5.0, 10), one_outage({-4.0, 1.0, 2.0}, 7.0, 8)};
  EXPECT_FALSE(drift_of(outages, false).against_gnss.has_value());
  outages[1].forward.gnss_horizontal_max_m = 2.5;
  ASSERT_TRUE(drift_of(outages, false).against_gnss.has_value());
  EXPECT_EQ(drift_of(outages, false).against_gnss->median, 2.5);
  EXPECT_FALSE(drift_of(outages, true).against_gnss.has_value());
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

// All m integrals known at either end: the last one's variance in the middle, given all at the end, against its own there.
TEST(SmoothingGain, AgreesWithConditioning) {
  for (const auto& [m, gain] : {std::pair{2, kSmoothingGainOfAccelNoise}, std::pair{3, kSmoothingGainOfGyroNoise}}) {
    // Of integral a at t and b at T >= t, in units of Q: each bit of the noise is s old, midpoint rule.
    const auto covariance = [](int a, int b, double t, double T) {
      constexpr int kSteps = 20000;
      double sum = 0.0;
      for (int k = 0; k < kSteps; ++k) {
        const double s = t * (k + 0.5) / kSteps;
        sum += std::pow(t - s, a - 1) * std::pow(T - s, b - 1) * t / kSteps;
      }
      return sum / std::tgamma(a) / std::tgamma(b);
    };
    Eigen::MatrixXd at_end(m, m);
    Eigen::VectorXd with_middle(m);
    for (int a = 1; a <= m; ++a) {
      for (int b = 1; b <= m; ++b) at_end(a - 1, b - 1) = covariance(a, b, 1.0, 1.0);
      with_middle(a - 1) = covariance(m, a, 0.5, 1.0);
    }
    const double middle = covariance(m, m, 0.5, 0.5) - with_middle.dot(at_end.ldlt().solve(with_middle));
    EXPECT_NEAR(std::sqrt(covariance(m, m, 1.0, 1.0) / middle), gain, 1e-5 * gain);  // 2e4 steps, squared, times 32^2
  }
}

}  // namespace
}  // namespace coast::study
