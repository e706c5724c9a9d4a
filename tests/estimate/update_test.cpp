// Every measurement's design matrix against finite differences on the manifold; then what an update does with it.

#include "coast/estimate/update.hpp"

#include <gtest/gtest.h>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/record/error.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;

const AuxiliaryStates kAllAuxiliaries{.lever_arm_sd_m = 0.05,
                                      .time_offset_sd_s = 0.02,
                                      .mounting_sd = 0.03,
                                      .base_offset_sd_m = 0.5,
                                      .correlated_gnss = {.horizontal_m = 0.02, .vertical_m = 0.04, .time_s = 60.0}};

class Updates : public testing::TestWithParam<UpdateKind> {
 protected:
  Updates() : layout_(test::error_model(test::kFullModel), geo::rotation_matrix({0.2, 2.8, -0.7}), kAllAuxiliaries) {}

  [[nodiscard]] FilterState random_state(std::uint64_t seed) {
    random_.seed(seed);
    FilterState state;
    state.nav = test::weaving(60.0).nav_state(test::mission_start(), 5.0 + static_cast<double>(seed));
    state.nav.q_b_e = state.nav.q_b_e * Eigen::Quaterniond(Eigen::Vector4d(test::normal_vector(4, random_))).normalized();
    state.x = Eigen::VectorXd::Zero(layout_.size());
    state.P = layout_.initial_covariance();
    state.x = state.P.diagonal().cwiseSqrt().cwiseProduct(test::normal_vector(layout_.size(), random_));
    const Eigen::MatrixXd A = test::random_covariance(layout_.size(), random_);
    const Eigen::VectorXd sd = state.P.diagonal().cwiseSqrt().cwiseMax(1e-6);
    state.P = sd.asDiagonal() * A * sd.asDiagonal();
    omega_ = 0.8 * test::normal_vector(3, random_);
    fix_.r_ea_e = state.nav.r_eb_e + test::normal_vector(3, random_);
    fix_.position_cov_n = 1e-4 * test::random_covariance(3, random_);
    fix_.velocity = record::GnssFix::Velocity{test::normal_vector(3, random_), 1e-4 * test::random_covariance(3, random_)};
    return state;
  }

  [[nodiscard]] Linearised linearised(const FilterState& state, const Eigen::VectorXd& x0) const {
    const Eigen::Vector3d omega = test::rate_at(layout_, omega_, x0, state);
    const UpdateContext context{layout_, {0.4, -0.6, -1.3}, omega, C_n_e_};
    switch (GetParam()) {
      case UpdateKind::kGnssPosition:
        return gnss_position(state, context, fix_);
      case UpdateKind::kGnssVelocity:
        return *gnss_velocity(state, context, fix_);
      case UpdateKind::kZeroVelocity:
        return zero_velocity(state, 0.01);
      case UpdateKind::kNonHolonomic:
        return non_holonomic(state, context, {.point_b = {-1.1, 0.3, 0.9}, .pitch = 0.1, .yaw = -0.2});
      case UpdateKind::kCarrierPhase:
      case UpdateKind::kMemberDifference:
      case UpdateKind::kHeadingHold:
      case UpdateKind::kAid:
        break;  // not of this form: tight_coupling_test.cpp, member_difference_test.cpp, aid_test.cpp
    }
    return {};
  }

  StateLayout layout_;
  std::mt19937_64 random_;
  record::GnssFix fix_;
  Eigen::Vector3d omega_;
  Eigen::Matrix3d C_n_e_ = geo::C_n_e({0.8, 0.1, 0.0});
};

TEST_P(Updates, DesignAgreesWithFiniteDifferencesOfTheInnovation) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const FilterState state = random_state(seed);
    const Linearised m = linearised(state, state.x);
    Eigen::VectorXd step = Eigen::VectorXd::Constant(layout_.size(), 0.1);  // linear in these
    step.segment<3>(kPos).setConstant(10.0);
    step.segment<3>(kPsi).setConstant(1e-4);
    step.segment<2>(*layout_.mounting()).setConstant(1e-4);
    const auto innovation_with = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      FilterState moved = state;
      remove_error(-step.cwiseProduct(d), moved.nav, moved.x);
      return linearised(moved, state.x).nu;
    };
    const Eigen::MatrixXd numeric =
        -test::finite_difference(innovation_with, layout_.size(), 1.0) * step.cwiseInverse().asDiagonal();
    const auto compare = [&](int first, int columns, const std::string& what) {
      // Third order of the step, and the rounding of coordinates of 4e6 m.
      const double scale = numeric.middleCols(first, columns).norm();
      const double rounding = 2e-9 / step(first);
      EXPECT_LE((m.H.middleCols(first, columns) - numeric.middleCols(first, columns)).norm(), 1e-7 * scale + rounding) << what;
    };
    compare(kPos, 3, "position");
    compare(kVel, 3, "velocity");
    compare(kPsi, 3, "attitude");
    for (const auto& block : layout_.sensors()) compare(block.offset, block.size, block.name);
    for (const auto& block : layout_.auxiliaries()) compare(block.offset, block.size, block.name);
  }
}

TEST_P(Updates, InnovationIsZeroWhereTheMeasurementIsWhatTheStatePredicts) {
  FilterState state = random_state(3);
  const Linearised m = linearised(state, state.x);
  const Eigen::MatrixXd R = m.R;
  EXPECT_EQ(m.nu.size(), m.H.rows());
  test::expect_near_matrix(R, R.transpose(), 1e-15, "R");
  // One Gauss-Newton step towards the measurement lands on it, to second order.
  const Eigen::VectorXd d = -m.H.transpose() * (m.H * m.H.transpose()).ldlt().solve(m.nu);
  FilterState there = state;
  remove_error(1e-3 * d, there.nav, there.x);
  const Linearised after = linearised(there, state.x);
  EXPECT_LE((after.nu - (1.0 - 1e-3) * m.nu).norm(), 1e-4 * m.nu.norm());
}

// Dense conditioning of the joint Gaussian of error and innovation.
TEST_P(Updates, UpdateIsTheConditionalGaussian) {
  FilterState state = random_state(4);
  const Linearised m = linearised(state, state.x);
  const FilterState before = state;
  const Innovation step = innovation(state, m);
  const AppliedUpdate applied = apply(m, step, state);

  const Eigen::MatrixXd S = m.H * before.P * m.H.transpose() + m.R;
  const Eigen::MatrixXd gain = before.P * m.H.transpose() * S.inverse();
  test::expect_near_matrix(step.S, S, 1e-13, "S");
  test::expect_near_matrix(applied.K, gain, 1e-10, "K");
  test::expect_near_matrix(state.P, before.P - gain * m.H * before.P, 1e-10, "P");
  EXPECT_EQ(state.P, state.P.transpose());
  const double nis = m.nu.dot(S.inverse() * m.nu);
  EXPECT_NEAR(step.nis, nis, 1e-10 * nis);
  const double log_likelihood = -0.5 * (nis + std::log((2.0 * M_PI * S).determinant()));
  EXPECT_NEAR(step.log_likelihood, log_likelihood, 1e-9 * std::abs(log_likelihood));
  // d = K y = -K nu is taken out of the state.
  FilterState expected = before;
  remove_error(-gain * m.nu, expected.nav, expected.x);
  EXPECT_LE((state.x - expected.x).norm(), 1e-10 * expected.x.norm());
  EXPECT_LE(error_between(state.nav, expected.nav).tail<6>().norm(), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(All, Updates,
                         testing::Values(UpdateKind::kGnssPosition, UpdateKind::kGnssVelocity, UpdateKind::kZeroVelocity,
                                         UpdateKind::kNonHolonomic),
                         [](const auto& kind) { return std::string(name(kind.param)); });

TEST(Update, AVelocityThatIsNotThereMeasuresNothing) {
  const StateLayout layout(test::error_model(test::kIndustrialModel), Eigen::Matrix3d::Identity(), {});
  FilterState state;
  state.x = Eigen::VectorXd::Zero(layout.size());
  const UpdateContext context{layout, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  EXPECT_FALSE(gnss_velocity(state, context, {}).has_value());
}

TEST(Update, ACovarianceThatIsNotPositiveIsNamed) {
  FilterState state;
  state.nav.t = test::mission_start();
  state.x = Eigen::VectorXd::Zero(kNav);
  state.P = -Eigen::MatrixXd::Identity(kNav, kNav);
  try {
    (void)innovation(state, zero_velocity(state, 0.01));
    FAIL();
  } catch (const NumericalError& e) {
    EXPECT_NE(std::string(e.what()).find("zero_velocity"), std::string::npos) << e.what();
  }
}

TEST(FilterState, ErrorsAddAndComeOutAgain) {
  std::mt19937_64 random(5);
  const record::NavState truth = test::weaving(60.0).nav_state(test::mission_start(), 12.0);
  Eigen::VectorXd d = 0.1 * test::normal_vector(kNav + 2, random);
  record::NavState estimate = truth;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(kNav + 2);
  remove_error(-d, estimate, x);
  EXPECT_LE((error_between(estimate, truth) - d.head<kNav>()).norm(), 1e-8);  // rounding of 4e6 m
  // C(est) = (I + [psi x]) C to first order: the definition, with a small angle.
  const Eigen::Vector3d psi(1e-6, -2e-6, 3e-6);
  record::NavState tilted = truth;
  d.setZero();
  d.segment<3>(kPsi) = psi;
  remove_error(-d, tilted, x);
  const Eigen::Matrix3d C = truth.q_b_e.toRotationMatrix();
  EXPECT_LE((tilted.q_b_e.toRotationMatrix() - (Eigen::Matrix3d::Identity() + geo::skew(psi)) * C).norm(), 2e-11);
}

TEST(FilterState, CovarianceIsTurnedIntoNorthEastDown) {
  std::mt19937_64 random(6);
  const Eigen::MatrixXd P = test::random_covariance(kNav, random);
  const geo::Geodetic p{-0.6, 2.2, 100.0};
  const record::NavCovariance cov = nav_covariance_n(P, geo::ecef_from_geodetic(p));
  // Down is the ellipsoid's normal: a direction known without any rotation matrix.
  const Eigen::Vector3d down(-std::cos(p.latitude) * std::cos(p.longitude), -std::cos(p.latitude) * std::sin(p.longitude),
                             -std::sin(p.latitude));
  EXPECT_NEAR(cov.position(2, 2), down.dot(P.block(0, 0, 3, 3) * down), 1e-12);
  EXPECT_NEAR(cov.velocity(2, 2), down.dot(P.block(3, 3, 3, 3) * down), 1e-12);
  EXPECT_NEAR(cov.attitude(2, 2), down.dot(P.block(6, 6, 3, 3) * down), 1e-12);
  EXPECT_NEAR(cov.attitude.trace(), P.diagonal().tail<3>().sum(), 1e-12);
}

}  // namespace
}  // namespace coast
