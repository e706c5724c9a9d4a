#include "coast/estimate/combination.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/record/error.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;
using Nav9 = Eigen::Matrix<double, kNav, 1>;

/// `error` off a state at the centre of the Earth, where positions have all their digits.
FilterState state_with(const Eigen::VectorXd& error, const Eigen::MatrixXd& P) {
  FilterState state{{}, Eigen::VectorXd::Zero(error.size()), P};
  remove_error(-error, state.nav, state.x);
  return state;
}

Eigen::VectorXd error_of(const FilterState& state) {
  Eigen::VectorXd d = state.x;
  d.head<kNav>() = error_between(state.nav, {});
  return d;
}

TEST(WeightedMean, IsTheTextbooksInOneDimension) {
  // North by two independent measurements, 5 m apart, sigma 2 m and 1 m: 4/5 of the way to the better one, variance 4/5.
  Eigen::MatrixXd P_f = Eigen::MatrixXd::Identity(kNav, kNav);
  P_f(0, 0) = 4.0;
  const Eigen::MatrixXd P_b = Eigen::MatrixXd::Identity(kNav, kNav);
  Nav9 e = Nav9::Zero();
  e(0) = 5.0;
  const FilterState both = weighted_mean(state_with(e, P_f), state_with(Nav9::Zero(), P_b), {});
  EXPECT_NEAR(both.nav.r_eb_e.x(), 1.0, 1e-14);
  EXPECT_NEAR(both.P(0, 0), 0.8, 1e-15);
  EXPECT_NEAR(both.P(1, 1), 0.5, 1e-15);
}

// Beside d, everything is linear but attitude: rotations of 1e-7 rad add up to 1e-14.
TEST(WeightedMean, EqualsTheDenseNormalEquations) {
  constexpr Eigen::Index kSize = kNav + 4;
  std::mt19937_64 random(1);
  for (int run = 0; run < 20; ++run) {
    // Each filter: a prior of the last four states, which both share, and measurements of its own.
    const Eigen::VectorXd prior = test::normal_vector(4, random).cwiseAbs2() + Eigen::VectorXd::Constant(4, 0.1);
    Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(kSize, kSize);
    shared.diagonal().tail(4) = prior.cwiseInverse();
    const Eigen::MatrixXd Y_f = test::random_covariance(kSize, random), Y_b = test::random_covariance(kSize, random);
    const Eigen::VectorXd z_f = 1e-7 * test::normal_vector(kSize, random), z_b = 1e-7 * test::normal_vector(kSize, random);
    const Eigen::MatrixXd P_f = (Y_f + shared).inverse(), P_b = (Y_b + shared).inverse();
    const FilterState both = weighted_mean(state_with(P_f * Y_f * z_f, P_f), state_with(P_b * Y_b * z_b, P_b), prior);
    const Eigen::MatrixXd P = (Y_f + Y_b + shared).inverse();
    test::expect_near_matrix(both.P, P, 1e-12, "covariance");
    test::expect_near_matrix(error_of(both), P * (Y_f * z_f + Y_b * z_b), 1e-6, "states");
  }
}

TEST(WeightedMean, LeavesAloneWhatBothKnow) {
  Eigen::MatrixXd P = Eigen::MatrixXd::Identity(kNav + 1, kNav + 1);
  P(kNav, kNav) = 0.0;
  Eigen::VectorXd e = Eigen::VectorXd::Zero(kNav + 1);
  e(kNav) = 0.3;
  const FilterState both = weighted_mean(state_with(e, P), state_with(e, P), Eigen::VectorXd::Zero(1));
  EXPECT_EQ(both.x(kNav), 0.3);
  EXPECT_EQ(both.P(kNav, kNav), 0.0);
  EXPECT_NEAR(both.P(0, 0), 0.5, 1e-15);
}

// Metres of a filter that has coasted for minutes, millimetres of the other, microradians beside both.
TEST(WeightedMean, KeepsItsDigitsWhereOneKnowsFarLess) {
  std::mt19937_64 random(2);
  Nav9 coarse, fine;
  coarse << 1e4, 1e4, 1e4, 50.0, 50.0, 50.0, 1e-2, 1e-2, 1e-2;
  fine << 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-6, 1e-6, 1e-6;
  const auto scaled = [&](const Nav9& sd) {
    return (sd.asDiagonal() * test::random_covariance(kNav, random) * sd.asDiagonal()).eval();
  };
  const Eigen::MatrixXd P_f = scaled(coarse), P_b = scaled(fine);
  const FilterState both = weighted_mean(state_with(1e-3 * coarse, P_f), state_with(Nav9::Zero(), P_b), {});
  // Both as they are: the coarse filter adds 1e-14 of itself. A rounding of W, 1e-16 between states of one unit, counts squared
  // beside the coarse variances, 1e14 of the fine ones, and once beside what is left of them.
  const Eigen::MatrixXd ratio = fine.cwiseInverse().asDiagonal() * (both.P - P_b) * fine.cwiseInverse().asDiagonal();
  EXPECT_LE(ratio.cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_GT(both.P.llt().matrixLLT().diagonal().minCoeff(), 0.0);
}

TEST(Contradiction, IsChiSquareOfNine) {
  std::mt19937_64 random(3);
  const Eigen::MatrixXd P_f = 1e-8 * test::random_covariance(kNav, random), P_b = 1e-8 * test::random_covariance(kNav, random);
  const Eigen::MatrixXd L_f = P_f.llt().matrixL(), L_b = P_b.llt().matrixL();
  constexpr int kDraws = 4000;
  double sum = 0.0;
  int beyond = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = contradiction(state_with(L_f * test::normal_vector(kNav, random), P_f),
                                   state_with(L_b * test::normal_vector(kNav, random), P_b));
    sum += u;
    if (u > noise::chi2_upper_quantile(9, 0.05)) ++beyond;
  }
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(9.0, kDraws);
  EXPECT_GT(sum / kDraws, bounds.lower);
  EXPECT_LT(sum / kDraws, bounds.upper);
  EXPECT_NEAR(beyond, 0.05 * kDraws, 4.0 * std::sqrt(0.05 * 0.95 * kDraws));
}

TEST(Contradiction, RefusesCovariancesThatAreNone) {
  const Eigen::MatrixXd P = -Eigen::MatrixXd::Identity(kNav, kNav);
  EXPECT_THROW(static_cast<void>(contradiction(state_with(Nav9::Zero(), P), state_with(Nav9::Zero(), P))), NumericalError);
}

/// Knots a second apart where both filters say what they are told to.
class CombineKnots : public testing::Test {
 protected:
  CombineKnots() : layout_(test::error_model(test::kIndustrialModel), Eigen::Matrix3d::Identity(), {}) {
    base_.r_eb_e = geo::ecef_from_geodetic({0.8, 0.1, 400.0});
  }
  struct Given {
    double apart_m = 0.0;  ///< forward minus backward, north pole's direction
    double sd_f = 1.0;     ///< of each component of the position, m
    double sd_b = 1.0;
    bool backward = true;  ///< has been there
  };
  [[nodiscard]] FilterState at(double second, double z, double sd) const {
    FilterState state{base_, Eigen::VectorXd::Zero(layout_.size()), layout_.initial_covariance()};
    state.nav.t = test::mission_start() + second;
    state.nav.r_eb_e.z() += z;
    state.P.diagonal().head<kNav>().setConstant(1e-4);
    state.P.diagonal().head<3>().setConstant(sd * sd);
    return state;
  }
  [[nodiscard]] Combination combined(const std::vector<Given>& given) const {
    KnotStore forward;
    std::vector<geo::GpsTime> times;
    for (std::size_t i = 0; i < given.size(); ++i) {
      const FilterState state = at(static_cast<double>(i), given[i].apart_m, given[i].sd_f);
      Knot knot;
      knot.post = {state.nav, state.x, {}};
      knot.P_post = state.P;
      forward.append(knot);
      times.push_back(state.nav.t);
    }
    BackwardKnots backward(layout_, times, at(0.0, 0.0, 1.0));
    for (std::size_t i = given.size(); i-- > 0;) {
      backward.add(at(static_cast<double>(i) + 0.5, 1e3, 1.0));  // at no knot
      if (given[i].backward) backward.add(at(static_cast<double>(i) + 1e-6, 0.0, given[i].sd_b));
    }
    return combine(forward, backward, layout_);
  }
  /// Where a knot lies between the backward filter (0) and the forward one.
  [[nodiscard]] double z(const SmoothedKnot& knot) const { return knot.nav.r_eb_e.z() - base_.r_eb_e.z(); }

  StateLayout layout_;
  record::NavState base_;
};

TEST_F(CombineKnots, NothingIsAveragedThatDiffersBeyondItsSigmas) {
  // sd of the difference sqrt(2) m; one of 1e6 knots exceeds 46.07 = 6.79^2 of chi2(9), one of 1e3 27.88 = 5.28^2.
  const double refuse = std::sqrt(2.0 * noise::chi2_upper_quantile(9, 1e-6));
  const double resume = std::sqrt(2.0 * noise::chi2_upper_quantile(9, 1e-3));
  const Combination c = combined({{},
                                  {.apart_m = 0.99 * refuse},
                                  {.apart_m = 1.01 * refuse, .sd_f = 0.99},     // forward is better
                                  {.apart_m = 20.0, .sd_f = 1.2, .sd_b = 0.9},  // not by enough to change
                                  {.apart_m = 20.0, .sd_f = 1.2, .sd_b = 0.8},  // less than half the variance
                                  {.apart_m = 1.01 * resume},                   // agrees, but not well
                                  {.apart_m = 0.99 * resume},
                                  {.apart_m = 100.0, .sd_f = 2.0, .sd_b = 1.0}});
  const std::vector<double> expected{0.0, 0.5 * 0.99 * refuse, 1.01 * refuse, 20.0, 0.0, 0.0, 0.5 * 0.99 * resume, 0.0};
  const std::vector<double> variance{0.5, 0.5, 0.99 * 0.99, 1.44, 0.64, 1.0, 0.5, 1.0};
  const std::vector<bool> jumps{false, false, true, false, true, false, true, true};
  ASSERT_EQ(c.knots.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(z(c.knots[i]), expected[i], 1e-8) << i;  // digits of a position on the Earth
    EXPECT_NEAR(c.knots[i].cov.position(0, 0), variance[i], 1e-12) << i;
    EXPECT_EQ(c.knots[i].jumps, jumps[i]) << i;
  }
  ASSERT_EQ(c.events.size(), 1U);
  EXPECT_EQ(c.events[0].kind, "combination_refused");
  EXPECT_EQ(c.events[0].severity, record::Event::Severity::kWarning);
  EXPECT_EQ(c.events[0].count, 5);
  EXPECT_EQ(c.events[0].time, test::mission_start() + 2.0);
  EXPECT_NE(c.events[0].text.find("5 of 8 knots, in 2 stretches, the longest 3.0 s"), std::string::npos) << c.events[0].text;
}

TEST_F(CombineKnots, WhereTheBackwardFilterHasNotBeenTheForwardOneStands) {
  const Combination c = combined({{.apart_m = 1.0, .backward = false}, {.apart_m = 1.0}, {.apart_m = 1.0}});
  EXPECT_NEAR(z(c.knots[0]), 1.0, 1e-8);
  EXPECT_NEAR(z(c.knots[1]), 0.5, 1e-8);
  EXPECT_TRUE(c.knots[1].jumps);
  EXPECT_FALSE(c.knots[2].jumps);
  EXPECT_TRUE(c.events.empty());
}

TEST_F(CombineKnots, WhatNeitherHasLearnedStaysAsTheErrorModelSays) {
  const Combination c = combined({{}, {}});
  const Eigen::VectorXd prior = layout_.initial_covariance().diagonal().cwiseSqrt();
  for (Eigen::Index i = kNav; i < layout_.size(); ++i) EXPECT_NEAR(c.knots[1].sd(i) / prior(i), 1.0, 1e-12) << i;
}

TEST_F(CombineKnots, SensorStatesAreWeightedByWhatEitherHasLearned) {
  // Prior 1, measurements of variance 1/3 by the forward and 1/2 by the backward filter: 1 + 3 + 2.
  const double prior = layout_.initial_covariance()(kNav, kNav);
  FilterState f = at(0.0, 0.0, 1.0), b = f;
  const double z_f = 4e-5, z_b = -1e-5;
  f.P(kNav, kNav) = prior / 4.0;
  f.x(kNav) = 3.0 / 4.0 * z_f;
  b.P(kNav, kNav) = prior / 3.0;
  b.x(kNav) = 2.0 / 3.0 * z_b;
  KnotStore forward;
  Knot knot;
  knot.post = {f.nav, f.x, {}};
  knot.P_post = f.P;
  forward.append(knot);
  BackwardKnots backward(layout_, {f.nav.t}, at(0.0, 0.0, 1.0));
  backward.add(b);
  const SmoothedKnot both = combine(forward, backward, layout_).knots[0];
  EXPECT_NEAR(both.sd(kNav) * both.sd(kNav) / prior, 1.0 / 6.0, 1e-12);
  // Its backward value leans on the prior as before, with the weight of what was learned: between the two.
  EXPECT_NEAR(both.x(kNav), (4.0 * f.x(kNav) + 2.0 * b.x(kNav)) / 6.0, 1e-12 * z_f);
}

/// A filter made to have knots at given instants.
class KnotsAt : public testing::Test {
 protected:
  KnotsAt() : model_(test::error_model(test::kIndustrialModel)) {
    options_.duration = 20.0;
    recording_ = test::make_recording(options_, nullptr, 1);
  }
  [[nodiscard]] std::vector<double> knots_with(const FilterOptions& filtering) const {
    const ForwardFilter filter(recording_.mission(), model_, filtering);
    std::vector<double> seconds;
    FilterOutputs outputs;
    outputs.at_knots = [&](const FilterState& state) { seconds.push_back(state.nav.t - test::mission_start()); };
    const test::StartSd sd;
    static_cast<void>(
        filter.run(filter.initial_state(recording_.truth(test::mission_start()), Eigen::Vector3d::Constant(sd.position),
                                        Eigen::Vector3d::Constant(sd.velocity), sd.attitude()),
                   outputs));
    return seconds;
  }
  noise::ImuErrorModel model_;
  test::RecordingOptions options_;
  test::Recording recording_;
};

TEST_F(KnotsAt, AreMadeBetweenSamplesAndInGapsAndOnlyOnceWhereAFixIs) {
  std::erase_if(recording_.imu.samples, [](const record::ImuSample& s) {
    const double t = s.t - test::mission_start();
    return t > 7.1 && t < 8.9;
  });
  FilterOptions filtering;
  const std::vector<double> before = knots_with(filtering);
  const std::vector<double> stops{-1.0, 3.1234567, 5.0 + 1e-6, 7.77, 8.123, 19.9, 30.0};
  for (const double stop : stops) filtering.knots_at.push_back(test::mission_start() + stop);
  const std::vector<double> after = knots_with(filtering);
  const auto has = [](const std::vector<double>& knots, double t) {
    return std::ranges::any_of(knots, [t](double knot) { return std::abs(knot - t) < 2.1e-6; });  // filter's tolerance
  };
  for (const double stop : {3.1234567, 5.0, 7.77, 8.123, 19.9}) {
    EXPECT_TRUE(has(after, stop)) << stop;
    EXPECT_EQ(std::ranges::count_if(after, [&](double knot) { return std::abs(knot - stop) < 1e-3; }), 1) << stop;
  }
  EXPECT_FALSE(has(before, 7.77));
  // Fillers come half a second behind any knot, so others move; those at fixes, whole seconds, do not.
  for (int second = 0; second <= 20; ++second) EXPECT_TRUE(has(after, second)) << second;
  EXPECT_TRUE(std::ranges::is_sorted(after));
}

// A solution that jumps by 10 m at a knot: before it the one, behind it the other, and nothing between.
TEST(CombinedEpochs, NothingLiesBetweenTwoSolutions) {
  const auto model = test::error_model(test::kIndustrialModel);
  test::RecordingOptions options;
  options.duration = 20.0;
  const test::Recording recording = test::make_recording(options, nullptr, 1);
  FilterOptions filtering;
  const ForwardFilter filter(recording.mission(), model, filtering);
  KnotStore knots;
  FilterOutputs outputs;
  outputs.knots = &knots;
  std::vector<record::NavState> filtered;
  outputs.epochs = [&](const record::TrajectoryEpoch& epoch) { filtered.push_back(epoch.nav); };
  const test::StartSd sd;
  static_cast<void>(
      filter.run(filter.initial_state(recording.truth(test::mission_start()), Eigen::Vector3d::Constant(sd.position),
                                      Eigen::Vector3d::Constant(sd.velocity), sd.attitude()),
                 outputs));
  constexpr double kJump = 10.0;
  const std::size_t at = knots.size() / 2;
  std::vector<SmoothedKnot> solution;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    SmoothedKnot knot;
    const Knot of = knots.at(i);
    knot.nav = of.post.nav;
    knot.cov.position = (i < at ? 1.0 : 4.0) * Eigen::Matrix3d::Identity();
    if (i >= at) knot.nav.r_eb_e.x() += kJump;
    knot.jumps = i == at;
    solution.push_back(knot);
  }
  std::size_t epochs = 0, jumped = 0;
  emit_smoothed(recording.mission(), filter.layout(), knots, solution, [&](const record::TrajectoryEpoch& epoch) {
    const bool behind = epoch.nav.t > knots.time(at);
    const auto same = std::ranges::find_if(filtered, [&](const auto& nav) { return std::abs(nav.t - epoch.nav.t) < 1e-6; });
    ASSERT_NE(same, filtered.end());
    // Error-free sensors: what the filter's updates move a knot by, interpolated, is centimetres.
    EXPECT_NEAR(epoch.nav.r_eb_e.x() - same->r_eb_e.x(), behind ? kJump : 0.0, 0.1) << epoch.nav.t - test::mission_start();
    EXPECT_NEAR(epoch.cov.position(0, 0), behind ? 4.0 : 1.0, 1e-12);
    ++epochs;
    if (behind) ++jumped;
  });
  EXPECT_GT(jumped, 500U);
  EXPECT_GT(epochs, jumped + 500U);
}

}  // namespace
}  // namespace coast
