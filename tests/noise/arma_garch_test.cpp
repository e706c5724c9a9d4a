#include "coast/noise/arma_garch.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "noise/arma_garch_models.hpp"

namespace coast::noise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct ArmaGarchCase {
  ArmaGarchOrders orders;
  bool with_gaps;
  ArmaGarchStart start;
};

std::vector<ArmaGarchCase> arma_garch_cases() {
  std::vector<ArmaGarchCase> all;
  const std::vector<ArmaGarchOrders> orders{{0, 0, 0, 0}, {3, 2, 1, 1}, {1, 1, 2, 2}, {2, 0, 0, 0},
                                            {0, 2, 1, 0}, {1, 0, 2, 1}, {0, 0, 1, 2}};
  for (const ArmaGarchOrders& o : orders)
    for (const bool with_gaps : {false, true})
      for (const ArmaGarchStart start : {ArmaGarchStart::kConditional, ArmaGarchStart::kFgarch})
        all.push_back({o, with_gaps, start});
  return all;
}

class EveryArmaGarch : public testing::TestWithParam<ArmaGarchCase> {
 protected:
  EveryArmaGarch() : model_(test::small_arma_garch(GetParam().orders)), y_(test::simulated_arma_garch(model_, 400, 3)) {
    if (GetParam().with_gaps) missing_ = test::some_missing_samples(y_.size());
    for (std::size_t t = 0; t < missing_.size(); ++t)
      if (missing_[t] != 0) y_[t] = std::nan("");  // must not be looked at
    // Not where the series is from: no gradient is to be zero by chance.
    model_.nu += 0.1;
    for (auto* part : {&model_.alpha, &model_.beta, &model_.gamma, &model_.delta})
      for (double& value : *part) value *= 0.8;
    options_.start = GetParam().start;
  }
  [[nodiscard]] ArmaGarchSeries series() const { return {y_, missing_}; }
  /// Derivative of the terms as written along a parameter. With steps h the formula of five points leaves h^4/30 of a fifth
  /// derivative (1e-16 of some 1e8) and 1e-15 of rounding over h.
  [[nodiscard]] VectorXd differences(Index parameter) const {
    constexpr double kStep = 1e-4;
    const VectorXd theta = arma_garch_vector(model_, true);
    const auto terms = [&](double away) {
      VectorXd at = theta;
      at(parameter) += away;
      const std::vector<double> all =
          test::terms_as_written(arma_garch_model(model_.orders(), true, at), series(), options_.start);
      return VectorXd(Eigen::Map<const VectorXd>(all.data(), std::ssize(all)));
    };
    return (8.0 * (terms(kStep) - terms(-kStep)) - terms(2.0 * kStep) + terms(-2.0 * kStep)) / (12.0 * kStep);
  }
  ArmaGarch model_;
  std::vector<double> y_;
  std::vector<std::uint8_t> missing_;
  ArmaGarchOptions options_;
};

INSTANTIATE_TEST_SUITE_P(ArmaGarch, EveryArmaGarch, testing::ValuesIn(arma_garch_cases()), [](const auto& c) {
  const ArmaGarchOrders& o = c.param.orders;
  return fmt::format("order{}{}{}{}{}{}", o.ar, o.ma, o.arch, o.garch, c.param.with_gaps ? "gaps" : "",
                     c.param.start == ArmaGarchStart::kFgarch ? "fgarch" : "");
});

TEST_P(EveryArmaGarch, LikelihoodIsThatOfTheEquations) {
  const std::vector<double> terms = test::terms_as_written(model_, series(), options_.start);
  const double expected = std::accumulate(terms.begin(), terms.end(), 0.0);
  EXPECT_NEAR(arma_garch_log_likelihood(model_, series(), options_.start), expected, 1e-11 * std::abs(expected));
}

TEST_P(EveryArmaGarch, GradientAndScoresAreThoseOfTheEquations) {
  const VectorXd gradient = arma_garch_gradient(model_, series(), options_);
  const MatrixXd scores = arma_garch_scores(model_, series(), options_);
  ASSERT_EQ(scores.rows(), std::ssize(y_));
  ASSERT_EQ(scores.cols(), gradient.size());
  for (Index i = 0; i < gradient.size(); ++i) {
    const VectorXd expected = differences(i);
    // 1e-10 of rounding a term, times the root of their number.
    EXPECT_NEAR(gradient(i), expected.sum(), 1e-8 * (1.0 + expected.cwiseAbs().sum())) << i;
    EXPECT_LT((scores.col(i) - expected).cwiseAbs().maxCoeff(), 1e-8 * (1.0 + expected.cwiseAbs().maxCoeff())) << i;
  }
}

TEST_P(EveryArmaGarch, WithoutConstantTheOtherDerivativesStay) {
  model_.nu = 0.0;
  ArmaGarchOptions without = options_;
  without.constant = false;
  const VectorXd all = arma_garch_gradient(model_, series(), options_);
  EXPECT_EQ(VectorXd(all.tail(all.size() - 1)), arma_garch_gradient(model_, series(), without));
}

TEST(ArmaGarch, PsiWeightsAndVarianceAreClosedFormsOfArma11) {
  const ArmaGarch m{.nu = 1.0, .alpha = {0.8}, .beta = {-0.5}, .gamma0 = 0.1, .gamma = {0.1}, .delta = {0.5}};
  const std::vector<double> psi = m.psi_weights(4);
  EXPECT_DOUBLE_EQ(psi[0], 1.0);
  EXPECT_DOUBLE_EQ(psi[1], 0.3);
  EXPECT_DOUBLE_EQ(psi[3], 0.3 * 0.64);
  EXPECT_DOUBLE_EQ(m.innovation_variance(), 0.25);
  EXPECT_NEAR(m.unconditional_variance(), 0.25 * (1.0 + 0.09 / 0.36), 1e-15);
  EXPECT_NEAR(m.mean(), 5.0, 1e-14);
  EXPECT_NEAR(m.nearest_root_pair().value(), 0.3, 1e-12);  // roots 0.8 and 0.5
  const ArmaGarch moving{.beta = {0.5, 0.2}, .gamma0 = 2.0};
  EXPECT_NEAR(moving.unconditional_variance(), 2.0 * 1.29, 1e-14);
  EXPECT_FALSE(moving.nearest_root_pair());
}

TEST(ArmaGarch, VarianceIsTheSumOfSquaredPsiWeights) {
  const ArmaGarch m = test::separated_arma_garch();
  double sum = 0.0;
  for (const double psi : m.psi_weights(1000)) sum += psi * psi;  // 0.9^1000 is nothing
  EXPECT_NEAR(m.unconditional_variance(), m.innovation_variance() * sum, 1e-12 * sum);
}

// Mean, variance and lag-one correlation of squares, which for GARCH(1,1) is gamma (1 - gamma delta - delta^2) /
// (1 - 2 gamma delta - delta^2): Bollerslev (1986).
TEST(ArmaGarch, SimulationHasTheModelsMoments) {
  const std::size_t n = 400000;
  const ArmaGarch m{.nu = 0.5, .alpha = {0.6}, .gamma0 = 0.3, .gamma = {0.15}, .delta = {0.6}};
  const std::vector<double> y = test::simulated_arma_garch(m, n, 1);
  const Eigen::ArrayXd x = Eigen::Map<const Eigen::ArrayXd>(y.data(), static_cast<Index>(n));
  // Standard deviation of the mean: sd of e/(1 - alpha)/sqrt n.
  EXPECT_NEAR(x.mean(), m.mean(), 3.3 * std::sqrt(m.innovation_variance()) / 0.4 / std::sqrt(n));
  const Eigen::ArrayXd c = x - m.mean();
  EXPECT_NEAR(c.square().mean() / m.unconditional_variance(), 1.0, 0.02);  // four deviations over twenty seeds
  const Eigen::ArrayXd e = c.tail(c.size() - 1) - 0.6 * c.head(c.size() - 1);
  const Eigen::ArrayXd s = e.square() - e.square().mean();
  const double rho = (s.head(s.size() - 1) * s.tail(s.size() - 1)).sum() / s.square().sum();
  EXPECT_NEAR(rho, 0.15 * (1.0 - 0.09 - 0.36) / (1.0 - 0.18 - 0.36), 0.02);  // five
}

TEST(ArmaGarch, VectorsGoThereAndBack) {
  const ArmaGarch m = test::small_arma_garch({2, 1, 1, 2});
  const std::vector<std::string> names{"nu", "alpha1", "alpha2", "beta1", "gamma0", "gamma1", "delta1", "delta2"};
  EXPECT_EQ(arma_garch_names(m.orders(), true), names);
  const VectorXd theta = arma_garch_vector(m, true);
  EXPECT_EQ(theta(0), 0.3);
  EXPECT_EQ(theta(3), 0.4);
  EXPECT_EQ(theta(4), 0.2);
  EXPECT_EQ(arma_garch_vector(arma_garch_model(m.orders(), true, theta), true), theta);
  EXPECT_EQ(arma_garch_vector(m, false).size(), 7);
}

TEST(ArmaGarch, RefusesWhatIsNoModelOrNoSeries) {
  const std::vector<double> y = test::simulated_arma_garch(test::small_arma_garch({1, 0, 0, 0}), 100, 1);
  EXPECT_NE((ArmaGarch{.alpha = {1.01}}).defect(), "");
  EXPECT_NE((ArmaGarch{.beta = {-1.2}}).defect(), "");
  EXPECT_NE((ArmaGarch{.gamma0 = 0.0}).defect(), "");
  EXPECT_NE((ArmaGarch{.gamma = {0.5}, .delta = {0.5}}).defect(), "");
  EXPECT_NE((ArmaGarch{.gamma = {-0.1}}).defect(), "");
  EXPECT_NE((ArmaGarch{.delta = {0.1}}).defect(), "");
  EXPECT_EQ((ArmaGarch{.alpha = {0.9}}).defect(), "");
  const std::vector<std::uint8_t> short_mask(99, 0);
  const std::vector<std::uint8_t> all_missing(100, 1);
  std::vector<double> infinite = y;
  infinite[7] = INFINITY;
  EXPECT_THROW(static_cast<void>(arma_garch_log_likelihood({.alpha = {1.0}}, {y})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(fit_arma_garch({y, short_mask}, {})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(fit_arma_garch({y, all_missing}, {})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(fit_arma_garch({infinite}, {})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(fit_arma_garch({y}, {0, 0, 0, 1})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(fit_arma_garch({y}, {-1, 0, 0, 0})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(fit_arma_garch({std::vector<double>(100, 2.0)}, {})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(choose_arma_garch({y}, {})), std::invalid_argument);
}

}  // namespace
}  // namespace coast::noise
