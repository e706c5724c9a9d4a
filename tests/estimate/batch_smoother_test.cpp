// The sparse batch solution against the smoother, against a dense joint normal distribution, and against wrong fixes.

#include "coast/estimate/batch_smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "coast/noise/chi_square.hpp"
#include "coast/record/error.hpp"
#include "estimate/batch_mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;
using test::Filtered;

/// Largest ratio among states that are not known exactly.
double largest_ratio(const Eigen::VectorXd& values, const Eigen::VectorXd& sd) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (sd(i) > 1e-15) largest = std::max(largest, std::abs(values(i)) / sd(i));
  return largest;
}

Eigen::VectorXd difference_of(const SmoothedKnot& a, const SmoothedKnot& b) {
  Eigen::VectorXd d = a.x - b.x;
  d.head<kNav>() = error_between(a.nav, b.nav);
  return d;
}

TEST(BatchSmoother, EqualsTheSmootherWhereEverythingIsLinear) {
  Filtered mission(test::still_model(100.0), test::still_recording(60.0), test::still_options(), 7, test::kStillStart);
  mission.run();
  const std::vector<SmoothedKnot> rts = smooth(mission.knots, mission.filter->layout());
  const BatchSolution batch = mission.batch();
  EXPECT_TRUE(batch.report.converged);
  ASSERT_EQ(batch.smoothed.size(), rts.size());
  for (std::size_t i = 0; i < rts.size(); ++i) {
    // The solvers agree to 1e-6 (linear_batch_test.cpp). Here the trajectory is integrated again where the smoother takes the
    // composed transitions, whose columns of Gauss-Markov states are right to kSubstep / (2 * 20 s) = 1e-3.
    EXPECT_LE(largest_ratio(difference_of(batch.smoothed[i], rts[i]), rts[i].sd), 1e-3) << i;
    EXPECT_LE(largest_ratio(batch.smoothed[i].sd - rts[i].sd, rts[i].sd), 1e-6) << i;
  }
}

// All states at all knots as one normal distribution, by the transitions of an open-loop run, conditioned on all fixes at once.
TEST(BatchSmoother, EqualsTheDenseConditionalDistribution) {
  FilterOptions options = test::still_options();
  Filtered mission(test::still_model(100.0), test::still_recording(9.0), options, 3, test::kStillStart);
  mission.run();
  options.withheld.push_back({test::mission_start() - 1.0, test::mission_start() + 100.0});
  const ForwardFilter open(mission.recording.mission(), mission.model, options);
  KnotStore store;
  FilterOutputs outputs;
  outputs.knots = &store;
  (void)open.run(mission.start, outputs);
  ASSERT_EQ(store.size(), mission.knots.size());

  const StateLayout& layout = open.layout();
  const Eigen::Index n = layout.size();
  const auto count = static_cast<Eigen::Index>(store.size());
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(n * count, n * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::MatrixXd across = store.at(static_cast<std::size_t>(i)).P_post;  // Cov(d_j, d_i), j = i, i + 1, ...
    for (Eigen::Index j = i; j < count; ++j) {
      joint.block(j * n, i * n, n, n) = across;
      joint.block(i * n, j * n, n, n) = across.transpose();
      if (j + 1 == count) break;
      const Knot knot = store.at(static_cast<std::size_t>(j));
      Eigen::MatrixXd moved = across;
      BlockTransitions(layout).over(knot.interval).apply(moved.bottomRows(n - kNav));
      if (knot.renews_gnss_error) moved.middleRows<3>(*layout.gnss_error()).setZero();
      moved.topRows<kNav>() = knot.Phi_n * across.topRows(knot.Phi_n.cols());
      across = moved;
    }
  }
  Eigen::MatrixXd H(0, n * count);
  Eigen::MatrixXd R(0, 0);
  Eigen::VectorXd nu(0);
  for (const KnotMeasurement& m : mission.measurements) {
    const Knot knot = store.at(m.knot);
    const FilterState state{knot.post.nav, knot.post.x, knot.P_post};
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(state.nav.r_eb_e));
    // The rate that the lever arm turns with: of the true motion, whose sensor errors matter to 1e-8 rad/s.
    const double t = state.nav.t - test::mission_start();
    constexpr double kHalf = 5e-3;
    const Eigen::Quaterniond before = mission.recording.truth(test::mission_start() + (t - kHalf)).q_b_e;
    const Eigen::Quaterniond after = mission.recording.truth(test::mission_start() + (t + kHalf)).q_b_e;
    const Eigen::AngleAxisd turn(before.conjugate() * after);
    const UpdateContext context{layout, mission.recording.lever_arm_b, turn.angle() / (2.0 * kHalf) * turn.axis(), C_n_e};
    const record::GnssFix& fix = mission.recording.gnss.fixes[m.what.index];
    const Linearised z =
        m.what.kind == UpdateKind::kGnssPosition ? gnss_position(state, context, fix) : *gnss_velocity(state, context, fix);
    const Eigen::Index rows = H.rows();
    H.conservativeResize(rows + 3, Eigen::NoChange);
    H.bottomRows<3>().setZero();
    H.block(rows, static_cast<Eigen::Index>(m.knot) * n, 3, n) = z.H;
    R.conservativeResize(rows + 3, rows + 3);
    R.rightCols<3>().setZero();
    R.bottomRows<3>().setZero();
    R.bottomRightCorner<3, 3>() = z.R;
    nu.conservativeResize(rows + 3);
    nu.tail<3>() = z.nu;
  }
  const Eigen::MatrixXd S = H * joint * H.transpose() + R;
  const Eigen::MatrixXd gain = S.ldlt().solve(H * joint).transpose();
  const Eigen::VectorXd d = -gain * nu;
  const Eigen::MatrixXd posterior = joint - gain * H * joint;

  const BatchSolution batch = mission.batch();
  for (Eigen::Index i = 0; i < count; ++i) {
    const SmoothedKnot& knot = batch.smoothed[static_cast<std::size_t>(i)];
    const Knot nominal = store.at(static_cast<std::size_t>(i));
    Eigen::VectorXd removed = nominal.post.x - knot.x;
    removed.head<kNav>() = error_between(nominal.post.nav, knot.nav);
    const Eigen::VectorXd sd = posterior.diagonal().segment(i * n, n).cwiseSqrt();
    // The lever arm's rate differs by what the strapdown takes for the rate between two samples: 1e-5 rad/s on 1 m.
    EXPECT_LE(largest_ratio(removed - d.segment(i * n, n), sd), 2e-3) << i;
    EXPECT_LE(largest_ratio(knot.sd - sd, sd), 1e-5) << i;
  }
}

// Kinds of layouts: nothing but unknowns at knots; and states that nobody doubts, whose mean drifts.
TEST(BatchSmoother, EqualsTheSmootherWithoutUnknownsOfTheMissionAndWithKnownDrifts) {
  const std::string driven = R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 2e-3, unit: deg/sqrt(h)}, {process: gauss_markov, sigma: 0.1, unit: deg/h, correlation_time_s: 300}]
accel:
  all: [{process: white_noise, density: 100, unit: ug/sqrt(Hz)}, {process: gauss_markov, sigma: 20, unit: ug, correlation_time_s: 300}]
)";
  std::string drifting = driven;
  drifting.insert(drifting.find("gauss_markov") - 10, "{process: drift, slope: 50, unit: deg/h/h}, ");
  for (const std::string& model : {driven, drifting}) {
    Filtered mission(model, test::still_recording(30.0), {}, 5,
                     {.position = 0.05, .velocity = 2e-3, .tilt = 1e-5, .heading = 1e-5});
    mission.run();
    const std::vector<SmoothedKnot> rts = mission.smoothed();
    const BatchSolution batch = mission.batch();
    EXPECT_TRUE(batch.report.unknowns.empty());
    for (std::size_t i = 0; i < rts.size(); ++i) {
      EXPECT_LE(largest_ratio(difference_of(batch.smoothed[i], rts[i]), rts[i].sd), 2e-3) << i;
      EXPECT_LE(largest_ratio(batch.smoothed[i].sd - rts[i].sd, rts[i].sd), 1e-5) << i;
    }
  }
}

TEST(BatchSmoother, MoreMemoryThanAllowedIsNamedBeforeItIsTaken) {
  Filtered mission(test::kIndustrialModel, test::still_recording(30.0), {}, 1, {});
  mission.run();
  // 9 + 6 driven states at each knot, 12 constants: 15 * 16 / 2 + 15 * 15 + 15 * 12 = 525 elements a knot, but for the first.
  const auto elements = static_cast<std::int64_t>(525 * mission.knots.size() - 225 + 78);
  EXPECT_NO_THROW((void)mission.batch({.most_bytes = 24 * elements}));
  try {
    (void)mission.batch({.most_bytes = 24 * elements - 1});
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("the batch is too large"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("smoother: rts"), std::string::npos) << error.what();
  }
}

TEST(BatchSmoother, OrdinaryMissionIsConsistent) {
  test::RecordingOptions recording_options;
  recording_options.duration = 120.0;
  recording_options.gnss.lever_arm_b = {0.5, 0.2, -1.0};
  FilterOptions options;
  options.auxiliary.lever_arm_sd_m = 0.05;
  options.withheld.push_back({test::mission_start() + 40.0, test::mission_start() + 80.0});
  double nees = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Filtered mission(test::kIndustrialModel, recording_options, options, seed, {});
    mission.run();
    const BatchSolution batch = mission.batch();
    EXPECT_TRUE(batch.report.converged) << seed;
    EXPECT_LE(batch.report.cost.size(), 9U) << seed;
    EXPECT_LE(batch.report.cost.back(), batch.report.cost.front()) << seed;
    for (const SmoothedKnot& knot : batch.smoothed) {
      const double t = knot.nav.t - test::mission_start();
      if (std::abs(t - 60.0) > 0.25 && std::abs(t - 20.0) > 0.25 && std::abs(t - 100.0) > 0.25) continue;
      const Eigen::VectorXd d = error_between(knot.nav, mission.recording.truth(knot.nav.t));
      nees += d.cwiseQuotient(knot.sd.head<kNav>()).squaredNorm();
      ++count;
    }
  }
  // Sums of squares of 9 correlated standardised errors; eight seeds, three epochs far apart: a wide bound on the mean of one.
  EXPECT_GT(nees / (kNav * count), 0.6);
  EXPECT_LT(nees / (kNav * count), 1.5);
}

double position_rms(const Filtered& mission, const std::vector<SmoothedKnot>& knots) {
  double sum = 0.0;
  for (const SmoothedKnot& knot : knots) sum += (knot.nav.r_eb_e - mission.recording.truth(knot.nav.t).r_eb_e).squaredNorm();
  return std::sqrt(sum / static_cast<double>(knots.size()));
}

// 2 % of fixes off by 0.2 to 2 m in any direction, sigmas stated as ever.
void spoil(record::GnssRecording& gnss, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  for (record::GnssFix& fix : gnss.fixes) {
    if (uniform(random) > 0.02) continue;
    const Eigen::Vector3d direction = test::normal_vector(3, random).normalized();
    fix.r_ea_e += (0.2 + 1.8 * uniform(random)) * direction;
  }
}

TEST(BatchSmoother, WrongFixesCostARobustLossLittle) {
  test::RecordingOptions recording_options;
  recording_options.duration = 240.0;
  recording_options.gnss.rate_hz = 5.0;
  FilterOptions options;
  options.gate_probability = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Filtered clean(test::kIndustrialModel, recording_options, options, seed, {});
    clean.run();
    const double undisturbed = position_rms(clean, clean.batch().smoothed);
    Filtered wrong(test::kIndustrialModel, recording_options, options, seed, {});
    spoil(wrong.recording.gnss, seed);
    wrong.begin(seed, {});
    wrong.run();
    for (const auto kind : {RobustLoss::Kind::kHuber, RobustLoss::Kind::kCauchy, RobustLoss::Kind::kGemanMcClure}) {
      const BatchSolution robust = wrong.batch({.gnss = {.kind = kind}});
      const double rms = position_rms(wrong, robust.smoothed);
      if (kind == RobustLoss::Kind::kGemanMcClure) {
        EXPECT_LT(rms, 1.1 * undisturbed) << seed;
      }
      EXPECT_LT(rms, 1.5 * undisturbed) << seed << " " << static_cast<int>(kind);
    }
    EXPECT_GT(position_rms(wrong, wrong.batch().smoothed), 1.5 * undisturbed) << seed;
  }
}

TEST(RobustLoss, WeightIsTheSlopeOfTheValue) {
  for (const auto kind :
       {RobustLoss::Kind::kSquared, RobustLoss::Kind::kHuber, RobustLoss::Kind::kCauchy, RobustLoss::Kind::kGemanMcClure}) {
    const RobustLoss loss{.kind = kind, .scale = 1.7};
    for (const double u2 : {0.01, 1.0, 2.8, 3.0, 50.0, 1e4}) {
      const double h = 1e-5 * u2;
      EXPECT_NEAR((loss.value(u2 + h) - loss.value(u2 - h)) / (2.0 * h), loss.weight(u2), 1e-6) << static_cast<int>(kind);
    }
    EXPECT_EQ(loss.value(0.0), 0.0);
    EXPECT_EQ(loss.weight(0.0), 1.0);
  }
}

}  // namespace
}  // namespace coast
