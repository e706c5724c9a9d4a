#include "coast/simulate/gnss.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "coast/geo/units.hpp"
#include "coast/simulate/motions.hpp"
#include "support/support.hpp"

namespace coast::simulate {
namespace {

using Eigen::Vector3d;
using geo::kDegree;

const geo::GpsTime kStart = geo::GpsTime::from_week(2374, 208800.0);

AnalyticTrajectory drive() {
  MotionParameters parameters;
  parameters.origin = {46.52 * kDegree, 6.57 * kDegree, 400.0};
  parameters.duration = 400.0;
  return make_motion("city", parameters);
}

// A body at rest for long: statistics without motion.
AnalyticTrajectory rest(double duration) {
  MotionPlan plan;
  plan.origin = {-33.9 * kDegree, -70.6 * kDegree, 520.0};
  plan.duration = duration;
  return AnalyticTrajectory(plan);
}

std::vector<Vector3d> errors_n(const record::GnssRecording& recording, const AnalyticTrajectory& truth) {
  const Vector3d r_e = truth.at(0.0).r_eb_e;
  const Eigen::Matrix3d C_e_n = geo::C_n_e(truth.plan().origin).transpose();
  std::vector<Vector3d> errors;
  for (const record::GnssFix& fix : recording.fixes) errors.push_back(C_e_n * (fix.r_ea_e - r_e));
  return errors;
}

TEST(GnssFixes, WithoutNoiseAreTheAntennasPositionAndVelocityAtTheExactTime) {
  const AnalyticTrajectory truth = drive();
  GnssOptions options;
  options.rate_hz = 4.0;
  options.phase = 0.137;
  options.lever_arm_b = Vector3d(0.4, -0.3, -1.2);
  options.sd.setZero();
  options.stated_sd = Vector3d(0.01, 0.01, 0.02);
  options.velocity_sd = Vector3d::Constant(1e-12);
  options.time_offset = 0.05;
  const record::GnssRecording recording = gnss_fixes(truth, kStart, options, 1);
  ASSERT_EQ(recording.fixes.size(), 1600u);  // 0.137 + 0.25 k <= 400
  EXPECT_NEAR(recording.fixes.front().t - kStart, 0.137, 1e-9);
  for (const record::GnssFix& fix : recording.fixes) {
    const double valid = (fix.t - kStart) - 0.05;
    const Kinematics k = truth.at(valid);
    // ECEF rounding, and 1 ns of time at 14 m/s
    EXPECT_LT((fix.r_ea_e - k.r_eb_e - k.C_b_e * options.lever_arm_b).norm(), 2e-8);
    const Vector3d v_e = k.v_eb_e + k.C_b_e * k.omega_eb_b.cross(options.lever_arm_b);
    EXPECT_LT((geo::C_n_e(geo::geodetic_from_ecef(fix.r_ea_e)) * fix.velocity->v_ea_n - v_e).norm(), 2e-8);
    EXPECT_EQ(fix.position_cov_n.diagonal(), Vector3d(1e-4, 1e-4, 4e-4));
    EXPECT_EQ(fix.quality, record::FixQuality::kFixed);
  }
}

TEST(GnssFixes, WhiteNoiseHasItsVarianceNorthEastDown) {
  const AnalyticTrajectory truth = rest(20000.0);
  GnssOptions options;
  options.sd = Vector3d(0.5, 1.0, 2.0);
  options.velocity_sd = Vector3d(0.1, 0.2, 0.3);
  const record::GnssRecording recording = gnss_fixes(truth, kStart, options, 4);
  Vector3d position = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  double cross = 0.0;
  const std::vector<Vector3d> errors = errors_n(recording, truth);
  const auto n = static_cast<double>(errors.size());
  for (std::size_t k = 0; k < errors.size(); ++k) {
    position += errors[k].cwiseQuotient(options.sd).cwiseAbs2() / n;
    velocity += recording.fixes[k].velocity->v_ea_n.cwiseQuotient(*options.velocity_sd).cwiseAbs2() / n;
    cross += errors[k].x() * errors[k].y() / n;
  }
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(1.0, n);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(position[i], bounds.lower);
    EXPECT_LT(position[i], bounds.upper);
    EXPECT_GT(velocity[i], bounds.lower);
    EXPECT_LT(velocity[i], bounds.upper);
  }
  EXPECT_LT(std::abs(cross), 3.3 * 0.5 / std::sqrt(n));
}

// R(tau) = sigma^2 exp(-tau / T) plus the white variance at lag 0; tolerance: four Bartlett deviations, 2 sigma^4 2T / span.
TEST(GnssFixes, CorrelatedErrorHasItsAutocovariance) {
  const double span = 30000.0;
  const AnalyticTrajectory truth = rest(span);
  GnssOptions options;
  options.sd = Vector3d::Constant(0.003);
  options.correlated = GnssOptions::Correlated{Vector3d(0.01, 0.02, 0.04), 3.0};
  const record::GnssRecording recording = gnss_fixes(truth, kStart, options, 2);
  const std::vector<Vector3d> errors = errors_n(recording, truth);
  const double tolerance = 4.0 * std::sqrt(2.0 * 2.0 * 3.0 / span);
  for (std::size_t lag : {0u, 1u, 3u, 9u}) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t k = lag; k < errors.size(); ++k) sum += errors[k].cwiseProduct(errors[k - lag]);
    sum /= static_cast<double>(errors.size() - lag);
    for (int i = 0; i < 3; ++i) {
      const double sigma2 = std::pow(options.correlated->sd[i], 2);
      const double white = lag == 0 ? 9e-6 : 0.0;
      EXPECT_NEAR(sum[i], sigma2 * std::exp(-static_cast<double>(lag) / 3.0) + white, tolerance * sigma2) << lag << " " << i;
    }
  }
  // Stated: both together.
  EXPECT_NEAR(recording.fixes[5].position_cov_n(1, 1), 4e-4 + 9e-6, 1e-15);
}

TEST(GnssFixes, GapsRemoveFixesAndChangeNoOther) {
  const AnalyticTrajectory truth = drive();
  GnssOptions options;
  options.correlated = GnssOptions::Correlated{};
  options.correlated->sd = Vector3d::Constant(0.02);
  const record::GnssRecording all = gnss_fixes(truth, kStart, options, 9);
  options.gaps = {{100.0, 20.0}, {200.0, 5.0}};
  const record::GnssRecording some = gnss_fixes(truth, kStart, options, 9);
  EXPECT_EQ(some.fixes.size() + 25, all.fixes.size());
  std::size_t i = 0;
  for (const record::GnssFix& fix : all.fixes) {
    const double t = fix.t - kStart;
    if ((t >= 100.0 && t < 120.0) || (t >= 200.0 && t < 205.0)) continue;
    EXPECT_EQ(some.fixes[i].t, fix.t);
    EXPECT_EQ(some.fixes[i++].r_ea_e, fix.r_ea_e);
  }
}

TEST(GnssFixes, DegradedStretchesScaleErrorsAndStatedSigmas) {
  const AnalyticTrajectory truth = rest(100.0);
  GnssOptions options;
  const std::vector<Vector3d> clean = errors_n(gnss_fixes(truth, kStart, options, 9), truth);
  options.degraded = {{{50.0, 10.0}, record::FixQuality::kFloat, 40.0, 3.0}};
  const record::GnssRecording recording = gnss_fixes(truth, kStart, options, 9);
  const std::vector<Vector3d> errors = errors_n(recording, truth);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const bool bad = k >= 50 && k < 60;
    EXPECT_LT((errors[k] - (bad ? 40.0 : 1.0) * clean[k]).norm(), 1e-7);  // ECEF rounding, 40 times
    EXPECT_EQ(recording.fixes[k].quality, bad ? record::FixQuality::kFloat : record::FixQuality::kFixed);
    EXPECT_NEAR(std::sqrt(recording.fixes[k].position_cov_n(2, 2)), bad ? 0.06 : 0.02, 1e-15);
  }
}

TEST(GnssFixes, RefuseWhatNoReceiverStates) {
  const AnalyticTrajectory truth = rest(10.0);
  GnssOptions options;
  options.sd.setZero();
  EXPECT_THROW((void)gnss_fixes(truth, kStart, options, 1), std::invalid_argument);  // a stated sigma of zero
  options.sd = Vector3d(0.1, -0.1, 0.1);
  EXPECT_THROW((void)gnss_fixes(truth, kStart, options, 1), std::invalid_argument);
  options.sd = Vector3d(0.1, 0.1, 0.1);
  options.rate_hz = 0.0;
  EXPECT_THROW((void)gnss_fixes(truth, kStart, options, 1), std::invalid_argument);
}

}  // namespace
}  // namespace coast::simulate
