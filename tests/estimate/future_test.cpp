// What lies behind a knot, against the smoother of the whole run, of another run, and against dense brute force.

#include "coast/estimate/future.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>

#include "coast/estimate/smoother.hpp"
#include "estimate/mission.hpp"
#include "support/spectra.hpp"

namespace coast {
namespace {

using namespace estimate;

/// Some seconds of the weaving drive, all errors `scale` times those of an industrial IMU and centimetre GNSS.
class FutureMission {
 public:
  explicit FutureMission(double scale, double duration = 9.0) : model_(test::error_model(model_text(scale))), scale_(scale) {
    simulate::GnssOptions gnss;
    gnss.phase = 0.0137;
    gnss.rate_hz = 1.3;
    gnss.sd *= scale;
    gnss.lever_arm_b = {0.5, 0.2, -1.0};
    gnss.velocity_sd = scale * Eigen::Vector3d(0.05, 0.05, 0.08);
    recording_ = test::make_recording({.duration = duration, .gnss = gnss}, &model_, 4);
    mission_ = std::make_unique<Mission>(recording_.mission());
    FilterOptions options;
    options.gate_probability = 0.0;
    options.auxiliary.lever_arm_sd_m = 0.1 * scale;
    options.auxiliary.correlated_gnss = {.horizontal_m = 0.02 * scale, .vertical_m = 0.03 * scale, .time_s = 20.0};
    filter_ = std::make_unique<ForwardFilter>(*mission_, model_, options);
  }

  [[nodiscard]] FilterState start() const {
    std::mt19937_64 random(9);
    const test::StartSd sd{0.1 * scale_, 0.05 * scale_, 2e-3 * scale_, 5e-3 * scale_};
    return test::drawn_start(*filter_, recording_.truth(test::mission_start()), sd, random);
  }
  /// @param P_pred  takes the covariance before each knot's updates
  [[nodiscard]] KnotStore filtered(const FilterState& from, std::vector<Eigen::MatrixXd>* P_pred = nullptr) const {
    KnotStore knots;
    FilterOutputs outputs;
    outputs.knots = &knots;
    if (P_pred != nullptr) outputs.at_knots = [P_pred](const FilterState& state) { P_pred->push_back(state.P); };
    static_cast<void>(filter_->run(from, outputs));
    return knots;
  }
  [[nodiscard]] const ForwardFilter& filter() const { return *filter_; }
  [[nodiscard]] const StateLayout& layout() const { return filter_->layout(); }

 private:
  static std::string model_text(double scale) {
    const auto of = [scale](const char* process, double value, const char* unit, const char* more = "") {
      return fmt::format("{{process: {}, {}: {}, unit: {}{}}}", process,
                         std::string_view(process) == "white_noise" ? "density" : "sigma", scale * value, unit, more);
    };
    return fmt::format("schema: coast.imu_error_model/1\ngyro: {{all: [{}, {}, {}, {}]}}\naccel: {{all: [{}, {}, {}]}}\n",
                       of("white_noise", 0.2, "deg/sqrt(h)"), of("random_constant", 30.0, "deg/h"),
                       of("gauss_markov", 6.0, "deg/h", ", correlation_time_s: 100"), of("scale_factor", 500.0, "ppm"),
                       of("white_noise", 80.0, "ug/sqrt(Hz)"), of("random_constant", 2.0, "mg"),
                       of("scale_factor", 500.0, "ppm"));
  }

  noise::ImuErrorModel model_;
  double scale_;
  test::Recording recording_;
  std::unique_ptr<Mission> mission_;
  std::unique_ptr<ForwardFilter> filter_;
};

KnotStore first_knots(const KnotStore& knots, std::size_t count) {
  KnotStore first;
  for (std::size_t i = 0; i < count; ++i) first.append(knots.at(i));
  return first;
}

Future future_at(const KnotStore& knots, const StateLayout& layout, std::size_t knot) {
  return futures(knots, layout, std::array{knot}).front();
}

/// Largest difference of states and of their sigmas, in sigmas of `b`; of positions less what their coordinates are rounded by.
struct Differences {
  double position = 0.0;
  double others = 0.0;
  double sigmas = 0.0;
};
Differences differences(const std::vector<SmoothedKnot>& a, const std::vector<SmoothedKnot>& b, std::size_t count) {
  Differences largest;
  const auto raise = [](double& value, const Eigen::VectorXd& by) { value = std::max(value, by.cwiseAbs().maxCoeff()); };
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::VectorXd d = a[i].x - b[i].x;
    d.head<kNav>() = error_between(a[i].nav, b[i].nav);
    constexpr double kRounding = 2e-9;  // m, coordinates of some 5e6 m
    raise(largest.position, ((d.head<3>().cwiseAbs().array() - kRounding).max(0.0) / b[i].sd.head<3>().array()).matrix());
    raise(largest.others, d.tail(d.size() - 3).cwiseQuotient(b[i].sd.tail(d.size() - 3)));
    raise(largest.sigmas, (a[i].sd - b[i].sd).cwiseQuotient(b[i].sd));
  }
  return largest;
}

Eigen::VectorXd sd_of(const Knot& knot) {
  return knot.P_post.diagonal().cwiseSqrt();
}

// L and l come with the inverse of I - N P, r and N again with that of I + L P = (I - N P)^-1. Rounding, n 2e-16, times the
// condition number of that matrix in sigmas of the filter (up to 5000); attitudes are rounded to 1e-16 rad, 1e-12 sigma.
TEST(Future, ContinuesItsOwnRun) {
  const FutureMission mission(1.0);
  const KnotStore knots = mission.filtered(mission.start());
  ASSERT_GT(knots.size(), 20U);
  const auto whole = smooth(knots, mission.layout());
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const Future behind = future_at(knots, mission.layout(), k);
    const auto cut = smooth(first_knots(knots, k + 1), mission.layout(), {}, KnotSampling{}, &behind);
    ASSERT_EQ(cut.size(), k + 1);
    const Knot knot = knots.at(k);
    const Eigen::VectorXd s = sd_of(knot);
    const Eigen::MatrixXd LP = s.asDiagonal() * behind.information * knot.P_post * s.cwiseInverse().asDiagonal();
    const double condition = test::condition_number(Eigen::MatrixXd::Identity(LP.rows(), LP.cols()) + LP);
    const Differences d = differences(cut, whole, k + 1);
    const double tolerance = 1e-11 + 2.2e-16 * static_cast<double>(LP.rows()) * condition;
    EXPECT_LE(tolerance, 1e-9) << k;
    EXPECT_LE(d.position, tolerance) << k;
    EXPECT_LE(d.others, tolerance) << k;
    EXPECT_LE(d.sigmas, tolerance) << k;
  }
}

// Another prior, and so other gains, another nominal trajectory, another linearisation. What is left is of second order in the
// errors, in sigmas of first order: a tenth of all errors leaves a tenth of it, give or take where the largest one stands (a
// quarter at most; did it not fall with the errors it would be all of it).
TEST(Future, BelongsToAnyFilter) {
  for (const std::size_t k : {3U, 10U, 19U}) {
    std::array<Differences, 2> left;
    for (const std::size_t small : {0U, 1U}) {
      const FutureMission mission(small == 0 ? 0.1 : 0.01);
      const FilterState start = mission.start();
      const KnotStore first = mission.filtered(start);
      FilterState other = start;
      for (int i = 0; i < mission.layout().size(); ++i) {
        const double factor = i % 2 == 0 ? 3.0 : 0.5;
        other.P.row(i) *= factor;
        other.P.col(i) *= factor;
      }
      const KnotStore second = mission.filtered(other);
      const auto whole = smooth(second, mission.layout());
      const Future behind = future_at(first, mission.layout(), k);
      const auto cut = smooth(first_knots(second, k + 1), mission.layout(), {}, KnotSampling{}, &behind);
      left[small] = differences(cut, whole, k + 1);
      const Differences of_first = differences(smooth(first, mission.layout()), whole, k + 1);
      EXPECT_GT(of_first.position, 1.0);  // the prior matters
      EXPECT_GT(of_first.sigmas, 0.3);
    }
    EXPECT_LE(left[1].position, 0.25 * left[0].position) << k;
    EXPECT_LE(left[1].others, 0.25 * left[0].others) << k;
    EXPECT_LE(left[1].sigmas, 0.25 * left[0].sigmas) << k;
    EXPECT_LE(std::max({left[0].position, left[0].others, left[0].sigmas}), 0.03) << k;
  }
}

// The measurements behind a knot as one stack: with w the driving noise of all intervals,
//
//     y_j + H_j fed_j = H_j Phi(j, k) d + H_j (sum over i of Phi(j, i) w_i) + v_j
//
// fed_j is what feedback has taken out between the knot and y_j. With C the covariance of all but d and A the stack of
// H_j Phi(j, k):  L = A' C^-1 A,  l = A' C^-1 (y + H fed).
struct Stack {
  Eigen::MatrixXd A;
  Eigen::MatrixXd C;
  Eigen::VectorXd y;
};
Stack stack_behind(const KnotStore& knots, const StateLayout& layout, const std::vector<Eigen::MatrixXd>& P_pred,
                   std::size_t k) {
  const Eigen::Index n = layout.size();
  const auto intervals = static_cast<Eigen::Index>(knots.size() - 1 - k);
  Stack stack;
  std::vector<Eigen::RowVectorXd> A, G;
  std::vector<double> y;
  std::vector<Eigen::MatrixXd> R_blocks;
  Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(n * intervals, n * intervals);
  Eigen::MatrixXd from_d = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd from_w = Eigen::MatrixXd::Zero(n, n * intervals);
  Eigen::VectorXd fed = Eigen::VectorXd::Zero(n);
  for (std::size_t j = k + 1; j < knots.size(); ++j) {
    const Knot before = knots.at(j - 1);
    const auto at = n * static_cast<Eigen::Index>(j - 1 - k);
    Eigen::MatrixXd D = Eigen::MatrixXd::Identity(n - kNav, n - kNav);
    BlockTransitions(layout).over(before.interval).apply(D);
    Eigen::MatrixXd Phi = Eigen::MatrixXd::Zero(n, n);
    Phi.bottomRightCorner(n - kNav, n - kNav) = D;
    Phi.topLeftCorner(kNav, before.Phi_n.cols()) = before.Phi_n;
    Q.block(at, at, n, n) = P_pred[j] - Phi * before.P_post * Phi.transpose();
    from_d = (Phi * from_d).eval();
    from_w = (Phi * from_w).eval();
    from_w.middleCols(at, n).setIdentity();
    fed = (Phi * fed).eval();
    for (const AppliedUpdate& u : knots.at(j).updates) {
      for (Eigen::Index row = 0; row < u.y.size(); ++row) {
        A.emplace_back(u.H.row(row) * from_d);
        G.emplace_back(u.H.row(row) * from_w);
        y.push_back(u.y(row) + u.H.row(row).dot(fed));
      }
      fed += u.K * u.y;
      const Eigen::MatrixXd S = u.S_inv.inverse();
      R_blocks.emplace_back(S - u.H * u.K * S);  // R by what every gain satisfies: K S = P H'
    }
  }
  const auto m = static_cast<Eigen::Index>(A.size());
  stack.A.resize(m, n);
  stack.C.setZero(m, m);
  Eigen::MatrixXd noise(m, n * intervals);
  for (Eigen::Index row = 0; row < m; ++row) {
    stack.A.row(row) = A[static_cast<std::size_t>(row)];
    noise.row(row) = G[static_cast<std::size_t>(row)];
  }
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& R : R_blocks) {
    stack.C.block(at, at, R.rows(), R.rows()) = R;
    at += R.rows();
  }
  stack.C += noise * Q * noise.transpose();
  stack.y = Eigen::Map<const Eigen::VectorXd>(y.data(), m);
  return stack;
}

TEST(Future, IsWhatAllMeasurementsBehindSay) {
  const FutureMission mission(1.0, 4.0);
  std::vector<Eigen::MatrixXd> P_pred;
  const KnotStore knots = mission.filtered(mission.start(), &P_pred);
  ASSERT_GT(knots.size(), 8U);
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const Stack stack = stack_behind(knots, mission.layout(), P_pred, k);
    const Future future = future_at(knots, mission.layout(), k);
    const Knot knot = knots.at(k);
    EXPECT_EQ(future.nav.t, knot.post.nav.t);
    EXPECT_EQ(future.nav.r_eb_e, knot.post.nav.r_eb_e);
    EXPECT_EQ(future.x, knot.post.x);
    const Eigen::VectorXd s = sd_of(knot);
    const Eigen::LLT<Eigen::MatrixXd> C(stack.C);
    const Eigen::MatrixXd L = s.asDiagonal() * stack.A.transpose() * C.solve(stack.A) * s.asDiagonal();
    const Eigen::VectorXd l = s.cwiseProduct(stack.A.transpose() * C.solve(stack.y));
    const Eigen::MatrixXd by_recursion = s.asDiagonal() * future.information * s.asDiagonal();
    // The driving noise, a difference of covariances, is known to 1e-16 of them; the rest is rounding.
    EXPECT_LE((by_recursion - L).norm(), 1e-11 * L.norm()) << k;
    EXPECT_LE((s.cwiseProduct(future.vector) - l).norm(), 1e-11 * l.norm()) << k;
    EXPECT_LE((future.information - future.information.transpose()).norm(), 1e-15 * future.information.norm());
  }
}

TEST(Future, OfTheLastKnotIsNothingAndOfAKnotTwiceTheSame) {
  const FutureMission mission(1.0, 4.0);
  const KnotStore knots = mission.filtered(mission.start());
  const std::size_t last = knots.size() - 1;
  const std::vector<std::size_t> at{0, 0, 3, last, last};
  const std::vector<Future> all = futures(knots, mission.layout(), at);
  ASSERT_EQ(all.size(), at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Future alone = future_at(knots, mission.layout(), at[i]);
    EXPECT_EQ(all[i].information, alone.information) << i;
    EXPECT_EQ(all[i].vector, alone.vector) << i;
    EXPECT_EQ(all[i].nav.t, knots.time(at[i])) << i;
  }
  EXPECT_EQ(all[4].information, Eigen::MatrixXd::Zero(mission.layout().size(), mission.layout().size()));
  EXPECT_EQ(all[4].vector, Eigen::VectorXd::Zero(mission.layout().size()));
  EXPECT_GT(all[0].information.norm(), 0.0);
  EXPECT_TRUE(futures(knots, mission.layout(), {}).empty());
}

}  // namespace
}  // namespace coast
