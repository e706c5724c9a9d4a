// Filter and smoother against dense brute force on the same linearised problem, and against the textbook recursion.

#include "coast/estimate/smoother.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Dense>

#include "coast/estimate/forward_filter.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;

class SmootherTest : public testing::Test {
 protected:
  static constexpr std::size_t kFirstFloat = 4, kFixedAgain = 7;

  SmootherTest() : model_(test::error_model(test::kIndustrialModel)) {
    simulate::GnssOptions gnss;
    gnss.phase = 0.0137;
    gnss.rate_hz = 1.3;
    gnss.lever_arm_b = {0.5, 0.2, -1.0};
    gnss.velocity_sd = Eigen::Vector3d(0.05, 0.05, 0.08);
    recording_ = test::make_recording({.duration = 9.0, .gnss = gnss}, &model_, 4);
    test::float_between(recording_.gnss, kFirstFloat, kFixedAgain);
    FilterOptions options;
    options.gate_probability = 0.0;
    options.auxiliary.lever_arm_sd_m = 0.1;
    options.auxiliary.correlated_gnss = {.horizontal_m = 0.02, .vertical_m = 0.03, .time_s = 20.0};
    filter_ = std::make_unique<ForwardFilter>(recording_.mission(), model_, options);
    std::mt19937_64 random(9);
    const FilterState start = test::drawn_start(*filter_, recording_.truth(test::mission_start()), {}, random);
    P_start_ = start.P;
    FilterOutputs outputs;
    outputs.knots = &store_;
    outputs.at_knots = [this](const FilterState& state) { P_pred_.push_back(state.P); };
    (void)filter_->run(start, outputs);
    for (std::size_t i = 0; i < store_.size(); ++i) knots_.push_back(store_.at(i));
    smoothed_ = smooth(store_, filter_->layout());
  }

  [[nodiscard]] Eigen::Index size() const { return filter_->layout().size(); }
  /// Whether its interval ends at the first of the float fixes, or at the first behind them.
  [[nodiscard]] bool new_ambiguities_behind(const Knot& knot) const {
    const auto ends_at = [&](std::size_t fix) {
      return std::abs(recording_.gnss.fixes[fix].t - (knot.post.nav.t + knot.interval)) < 1e-5;
    };
    return ends_at(kFirstFloat) || ends_at(kFixedAgain);
  }
  [[nodiscard]] Eigen::MatrixXd dense_transition(const Knot& knot) const {
    Eigen::MatrixXd Phi = Eigen::MatrixXd::Identity(size(), size());
    Eigen::MatrixXd D = Eigen::MatrixXd::Identity(size() - kNav, size() - kNav);
    BlockTransitions(filter_->layout()).over(knot.interval).apply(D);
    if (new_ambiguities_behind(knot)) D.middleRows<3>(*filter_->layout().gnss_error() - kNav).setZero();
    Phi.bottomRightCorner(size() - kNav, size() - kNav) = D;
    Phi.topLeftCorner(kNav, knot.Phi_n.cols()) = knot.Phi_n;
    return Phi;
  }
  /// The error that smoothing takes out of the filtered state of knot i.
  [[nodiscard]] Eigen::VectorXd removed(std::size_t i) const {
    Eigen::VectorXd d = knots_[i].post.x - smoothed_[i].x;
    d.head<kNav>() = error_between(knots_[i].post.nav, smoothed_[i].nav);
    return d;
  }
  // Rounding of coordinates (1e-9 m) enters position beside the arithmetic's.
  void expect_same(const Eigen::VectorXd& d, const Eigen::MatrixXd& P, std::size_t i, double tolerance) const {
    const Eigen::VectorXd sd = P.diagonal().cwiseSqrt();
    const Eigen::VectorXd ratio = (removed(i) - d).cwiseAbs().cwiseQuotient(sd);
    EXPECT_LE(ratio.head<3>().maxCoeff(), tolerance + 2e-9 / sd.head<3>().minCoeff()) << i;
    EXPECT_LE(ratio.tail(size() - 3).maxCoeff(), tolerance) << i;
    EXPECT_LE((smoothed_[i].sd - sd).cwiseQuotient(sd).cwiseAbs().maxCoeff(), tolerance) << i;
  }

  noise::ImuErrorModel model_;
  test::Recording recording_;
  std::unique_ptr<ForwardFilter> filter_;
  Eigen::MatrixXd P_start_;
  KnotStore store_;
  std::vector<Eigen::MatrixXd> P_pred_;
  std::vector<Knot> knots_;
  std::vector<SmoothedKnot> smoothed_;
};

// At the first float fix and at the first fixed one behind, and nowhere else, the lasting error is as at the start: stationary,
// independent of everything.
TEST_F(SmootherTest, NewAmbiguitiesHaveANewLastingError) {
  const int g = *filter_->layout().gnss_error();
  int renewed = 0;
  std::size_t first_fix = 0;
  while (knots_[first_fix].updates.empty()) ++first_fix;
  for (std::size_t k = first_fix; k + 1 < knots_.size(); ++k) {
    const Eigen::MatrixXd& P = P_pred_[k + 1];
    Eigen::MatrixXd rows = P.middleRows<3>(g);
    rows.middleCols<3>(g).diagonal() -= Eigen::Vector3d(0.02 * 0.02, 0.02 * 0.02, 0.03 * 0.03);
    EXPECT_EQ(rows.cwiseAbs().maxCoeff() < 1e-18, new_ambiguities_behind(knots_[k])) << k;
    renewed += new_ambiguities_behind(knots_[k]) ? 1 : 0;
  }
  EXPECT_EQ(renewed, 2);
}

// All knots' errors as one Gaussian vector, conditioned on all measurements at once.
TEST_F(SmootherTest, EqualsTheDenseConditionalGaussian) {
  const auto n = size();
  const auto count = static_cast<Eigen::Index>(knots_.size());
  ASSERT_GT(count, 20);
  // Errors e of the trajectory without any feedback: e[k+1] = Phi e[k] + w. `fed` is what feedback has taken out by then.
  Eigen::MatrixXd P_all(n * count, n * count);
  std::vector<Eigen::RowVectorXd> rows;
  std::vector<double> z, fed_at_row;
  std::vector<Eigen::VectorXd> fed_after;
  std::vector<Eigen::MatrixXd> R_blocks;
  Eigen::VectorXd fed = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd M = P_start_;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Knot& knot = knots_[static_cast<std::size_t>(k)];
    P_all.block(n * k, n * k, n, n) = M;
    for (const AppliedUpdate& u : knot.updates) {
      for (Eigen::Index i = 0; i < u.y.size(); ++i) {
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n * count);
        row.segment(n * k, n) = u.H.row(i);
        rows.push_back(row);
        z.push_back(u.y(i) + u.H.row(i).dot(fed));
      }
      fed += u.K * u.y;
      // R by what every gain satisfies: K S = P H', hence S - H K S = R.
      const Eigen::MatrixXd S = u.S_inv.inverse();
      R_blocks.emplace_back(S - u.H * u.K * S);
    }
    fed_after.push_back(fed);
    if (k + 1 == count) break;
    const Eigen::MatrixXd Phi = dense_transition(knot);
    const Eigen::MatrixXd Q = P_pred_[static_cast<std::size_t>(k) + 1] - Phi * knot.P_post * Phi.transpose();
    fed = Phi * fed;
    M = Phi * M * Phi.transpose() + Q;
    for (Eigen::Index j = 0; j <= k; ++j) {
      P_all.block(n * (k + 1), n * j, n, n) = Phi * P_all.block(n * k, n * j, n, n);
      P_all.block(n * j, n * (k + 1), n, n) = P_all.block(n * (k + 1), n * j, n, n).transpose();
    }
  }
  const auto m = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd H(m, n * count), R = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index i = 0; i < m; ++i) H.row(i) = rows[static_cast<std::size_t>(i)];
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& block : R_blocks) {
    R.block(at, at, block.rows(), block.rows()) = block;
    at += block.rows();
  }
  const Eigen::MatrixXd HP = H * P_all;
  const Eigen::LLT<Eigen::MatrixXd> S(HP * H.transpose() + R);
  const Eigen::VectorXd e = HP.transpose() * S.solve(Eigen::Map<const Eigen::VectorXd>(z.data(), m));
  const Eigen::MatrixXd W = S.matrixL().solve(HP);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::MatrixXd W_k = W.middleCols(n * k, n);
    const Eigen::MatrixXd P = P_all.block(n * k, n * k, n, n) - W_k.transpose() * W_k;
    // Rounding times the condition of S.
    expect_same(e.segment(n * k, n) - fed_after[static_cast<std::size_t>(k)], P, static_cast<std::size_t>(k), 1e-9);
  }
}

// G = P Phi' P_pred^-1,  x_s = x + G (x_s' - x_pred'),  P_s = P + G (P_s' - P_pred') G'   Rauch, Tung, Striebel (1965)
TEST_F(SmootherTest, EqualsTheTextbookRecursion) {
  const std::size_t last = knots_.size() - 1;
  Eigen::VectorXd s = Eigen::VectorXd::Zero(size());
  Eigen::MatrixXd P_s = knots_[last].P_post;
  expect_same(s, P_s, last, 1e-12);
  for (std::size_t k = last; k-- > 0;) {
    const Knot& knot = knots_[k];
    const Eigen::MatrixXd Phi = dense_transition(knot);
    const Eigen::MatrixXd G = P_pred_[k + 1].ldlt().solve(Phi * knot.P_post).transpose();
    for (const AppliedUpdate& u : knots_[k + 1].updates) s += u.K * u.y;
    s = (G * s).eval();
    P_s = knot.P_post + G * (P_s - P_pred_[k + 1]) * G.transpose();
    expect_same(s, P_s, k, 1e-9);
  }
}

TEST_F(SmootherTest, KnotsComeBackAsTheyWerePut) {
  KnotStore spilled(20000);  // some four knots
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    spilled.append(knots_[i]);
    (void)spilled.at(i / 2);  // reading between writes
  }
  ASSERT_EQ(spilled.size(), knots_.size());
  for (std::size_t i = knots_.size(); i-- > 0;) {
    const Knot back = spilled.at(i);
    const Knot& put = knots_[i];
    EXPECT_EQ(spilled.time(i), put.post.nav.t);
    EXPECT_EQ(back.post.nav.t, put.post.nav.t);
    EXPECT_EQ(back.post.nav.r_eb_e, put.post.nav.r_eb_e);
    EXPECT_EQ(back.post.nav.v_eb_e, put.post.nav.v_eb_e);
    EXPECT_EQ(back.post.nav.q_b_e.coeffs(), put.post.nav.q_b_e.coeffs());
    EXPECT_EQ(back.post.x, put.post.x);
    EXPECT_EQ(back.post.previous.dtheta, put.post.previous.dtheta);
    EXPECT_EQ(back.post.previous.dv, put.post.previous.dv);
    EXPECT_EQ(back.P_post.triangularView<Eigen::Upper>().toDenseMatrix(),
              put.P_post.triangularView<Eigen::Upper>().toDenseMatrix());
    EXPECT_EQ(back.P_post, back.P_post.transpose());
    const Knot nominal = spilled.nominal_at(i);
    EXPECT_EQ(nominal.post.x, put.post.x);
    EXPECT_EQ(nominal.post.nav.q_b_e.coeffs(), put.post.nav.q_b_e.coeffs());
    EXPECT_EQ(nominal.remainder.dtheta, put.remainder.dtheta);
    EXPECT_EQ(nominal.interval, put.interval);
    EXPECT_EQ(back.next_sample, put.next_sample);
    EXPECT_EQ(back.remainder.dt, put.remainder.dt);
    EXPECT_EQ(back.remainder.dv, put.remainder.dv);
    EXPECT_EQ(back.interval, put.interval);
    EXPECT_EQ(back.Phi_n, put.Phi_n);
    ASSERT_EQ(back.updates.size(), put.updates.size());
    for (std::size_t u = 0; u < put.updates.size(); ++u) {
      EXPECT_EQ(back.updates[u].kind, put.updates[u].kind);
      EXPECT_EQ(back.updates[u].H, put.updates[u].H);
      EXPECT_EQ(back.updates[u].K, put.updates[u].K);
      EXPECT_EQ(back.updates[u].S_inv, put.updates[u].S_inv);
      EXPECT_EQ(back.updates[u].y, put.updates[u].y);
    }
  }
  const auto again = smooth(spilled, filter_->layout());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].nav.r_eb_e, smoothed_[i].nav.r_eb_e);
    EXPECT_EQ(again[i].sd, smoothed_[i].sd);
  }
}

// The backward recursion for N once more in extended precision: sd of all states at every knot.
std::vector<Eigen::VectorXd> extended_precision_sd(const KnotStore& store, const StateLayout& layout) {
  using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::Index n = layout.size();
  Extended N = Extended::Zero(n, n);
  std::vector<Eigen::VectorXd> sd(store.size());
  for (std::size_t i = store.size(); i-- > 0;) {
    const Knot knot = store.at(i);
    if (i + 1 < store.size()) {
      Eigen::MatrixXd D = Eigen::MatrixXd::Identity(n - kNav, n - kNav);
      BlockTransitions(layout).over(knot.interval).apply(D);
      Extended Phi = Extended::Zero(n, n);
      Phi.bottomRightCorner(n - kNav, n - kNav) = D.cast<long double>();
      Phi.topLeftCorner(kNav, knot.Phi_n.cols()) = knot.Phi_n.cast<long double>();
      N = (Phi.transpose() * N * Phi).eval();
    }
    const Extended P = knot.P_post.cast<long double>();
    sd[i] = (P - P * N * P).diagonal().cwiseSqrt().cast<double>();
    for (auto u = knot.updates.rbegin(); u != knot.updates.rend(); ++u) {
      const Extended H = u->H.cast<long double>();
      const Extended L = Extended::Identity(n, n) - u->K.cast<long double>() * H;
      N = (L.transpose() * N * L + H.transpose() * u->S_inv.cast<long double>() * H).eval();
    }
  }
  return sd;
}

// An IMU that drifts hundreds of metres in a minute, and centimetres at its end: nine digits lie between forward and smoothed
// variances there.
TEST(Smoother, KeepsItsDigitsThroughALongOutage) {
  const noise::ImuErrorModel model = test::error_model(R"(
schema: coast.imu_error_model/1
sensor: shaken consumer MEMS
rate_hz: 100
gyro: {all: [{process: white_noise, density: 0.15, unit: deg/s/sqrt(Hz)}, {process: random_constant, sigma: 0.5, unit: deg/s}]}
accel: {all: [{process: white_noise, density: 2000, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 20, unit: mg}]}
)");
  simulate::GnssOptions gnss;
  gnss.rate_hz = 4.0;
  const test::Recording recording = test::make_recording({.duration = 110.0, .gnss = gnss}, &model, 4);
  FilterOptions options;
  options.gate_probability = 0.0;
  options.withheld.push_back({test::mission_start() + 40.0, test::mission_start() + 100.0});
  const Mission mission = recording.mission();
  const ForwardFilter filter(mission, model, options);
  std::mt19937_64 random(9);
  KnotStore store;
  FilterOutputs outputs;
  outputs.knots = &store;
  (void)filter.run(test::drawn_start(filter, recording.truth(test::mission_start()), {}, random), outputs);
  const auto smoothed = smooth(store, filter.layout());
  const auto exact = extended_precision_sd(store, filter.layout());
  double largest_forward = 0.0;
  for (std::size_t i = 0; i < smoothed.size(); ++i) {
    const double forward = std::sqrt(store.at(i).P_post.diagonal().head<3>().maxCoeff());
    largest_forward = std::max(largest_forward, forward);
    // Rounding of P N P, 1e-16 of the forward variance times a condition number of P of some 1e5, against the smoothed one.
    const double tolerance = 1e-6 + 1e-11 * forward * forward / exact[i].head<3>().cwiseAbs2().minCoeff();
    EXPECT_LE(((smoothed[i].sd - exact[i]).cwiseQuotient(exact[i])).cwiseAbs().maxCoeff(), tolerance) << i;
    EXPECT_GT(smoothed[i].cov.position.diagonal().minCoeff(), 0.0) << i;
  }
  EXPECT_GT(largest_forward, 100.0);
}

// A push that no error model knows, at the beginning of an outage: the first fixes behind it lie outside the gate and are
// refused for a while. Once they are believed, the smoother must carry them back into the outage.
TEST(Smoother, BelievesTheFixesBehindAnOutageThatDriftedFurtherThanPredicted) {
  const noise::ImuErrorModel model = test::error_model(test::kIndustrialModel);
  simulate::GnssOptions gnss;
  gnss.rate_hz = 4.0;
  test::Recording recording = test::make_recording({.duration = 130.0, .gnss = gnss}, &model, 4);
  const geo::GpsTime from = test::mission_start() + 50.0, to = from + 40.0;
  constexpr double kPush = 0.3;  // m/s^2 for 5 s: 56 m at the end
  for (record::ImuSample& sample : recording.imu.samples)
    if (sample.t > from && sample.t < from + 5.0) sample.dv.x() += kPush * sample.dt;
  FilterOptions options;
  options.withheld.push_back({from, to});
  const Mission mission = recording.mission();
  const ForwardFilter filter(mission, model, options);
  std::mt19937_64 random(9);
  KnotStore store;
  double forward = 0.0, predicted = 0.0;
  FilterOutputs outputs;
  outputs.knots = &store;
  outputs.at_knots = [&](const FilterState& state) {
    if (state.nav.t < from || state.nav.t > to) return;
    forward = std::max(forward, (state.nav.r_eb_e - recording.truth(state.nav.t).r_eb_e).norm());
    predicted = std::max(predicted, std::sqrt(state.P.diagonal().head<3>().maxCoeff()));
  };
  const FilterResult result =
      filter.run(test::drawn_start(filter, recording.truth(test::mission_start()), {}, random), outputs);
  EXPECT_GT(forward, 5.0 * predicted);
  ASSERT_FALSE(result.events.empty());
  EXPECT_EQ(result.events.front().kind, "gate_opened");
  double smoothed = 0.0;
  for (const SmoothedKnot& knot : smooth(store, filter.layout()))
    if (knot.nav.t > from && knot.nav.t < to)
      smoothed = std::max(smoothed, (knot.nav.r_eb_e - recording.truth(knot.nav.t).r_eb_e).norm());
  // What the smoother has for a step of velocity at one end is a steady acceleration between both: a quarter of the drift.
  EXPECT_LT(smoothed, 0.35 * forward);
}

// At knots the emitted epochs are the smoothed knots; between them the trajectory obeys its own velocity.
TEST_F(SmootherTest, EmittedEpochsPassThroughTheKnots) {
  std::vector<record::TrajectoryEpoch> epochs;
  const Mission mission = recording_.mission();
  emit_smoothed(mission, filter_->layout(), store_, smoothed_, [&](const auto& epoch) { epochs.push_back(epoch); });
  ASSERT_EQ(epochs.size(), recording_.imu.samples.size() + 1);
  std::size_t met = 0;
  for (std::size_t i = 1; i < epochs.size(); ++i) {
    EXPECT_EQ(epochs[i].nav.t, recording_.imu.samples[i - 1].t);
    const double dt = epochs[i].nav.t - epochs[i - 1].nav.t;
    const Eigen::Vector3d moved = epochs[i].nav.r_eb_e - epochs[i - 1].nav.r_eb_e;
    const Eigen::Vector3d expected = 0.5 * dt * (epochs[i].nav.v_eb_e + epochs[i - 1].nav.v_eb_e);
    EXPECT_LE((moved - expected).norm(), 2e-4) << i;  // smoothed velocity jumps by some mm/s at a knot
    for (const SmoothedKnot& knot : smoothed_) {
      if (knot.nav.t != epochs[i].nav.t) continue;
      ++met;
      EXPECT_LE((knot.nav.r_eb_e - epochs[i].nav.r_eb_e).norm(), 1e-8);
      EXPECT_LE(error_between(knot.nav, epochs[i].nav).tail<6>().norm(), 1e-11);
      EXPECT_LE((knot.cov.position - epochs[i].cov.position).norm(), 1e-12 * knot.cov.position.norm());
    }
  }
  EXPECT_GE(met, 1u);
}

TEST_F(SmootherTest, EmittedBytesDoNotDependOnThreads) {
  FilterOptions options;
  options.knot_interval_s = 0.03;  // several chunks of intervals
  const Mission mission = recording_.mission();
  const ForwardFilter filter(mission, model_, options);
  std::mt19937_64 random(9);
  KnotStore store;
  FilterOutputs outputs;
  outputs.knots = &store;
  (void)filter.run(test::drawn_start(filter, recording_.truth(test::mission_start()), {}, random), outputs);
  const auto smoothed = smooth(store, filter.layout());
  const auto emitted = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<record::TrajectoryEpoch> epochs;
    emit_smoothed(mission, filter.layout(), store, smoothed, [&](const auto& epoch) { epochs.push_back(epoch); });
    return epochs;
  };
  const auto one = emitted(1), four = emitted(4);
  ASSERT_EQ(one.size(), recording_.imu.samples.size() + 1);
  ASSERT_EQ(four.size(), one.size());
  for (std::size_t i = 1; i < one.size(); ++i) {
    EXPECT_EQ(one[i].nav.t, recording_.imu.samples[i - 1].t);
    EXPECT_EQ(four[i].nav.t, one[i].nav.t);
    EXPECT_EQ(four[i].nav.r_eb_e, one[i].nav.r_eb_e);
    EXPECT_EQ(four[i].nav.q_b_e.coeffs(), one[i].nav.q_b_e.coeffs());
    EXPECT_EQ(four[i].cov.attitude, one[i].cov.attitude);
  }
}

}  // namespace
}  // namespace coast
