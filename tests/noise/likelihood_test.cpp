#include "coast/noise/likelihood.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <Eigen/QR>

#include "coast/noise/static_signal.hpp"
#include "noise/static_record.hpp"
#include "support/support.hpp"

namespace coast::noise {
namespace {

struct Case {
  const char* what;
  std::vector<const char*> processes;
  std::vector<double> values;  ///< of the parameters
  double interval;
  Mean mean;
};

std::vector<Case> cases() {
  return {
      {"slow", {"white_noise", "gauss_markov"}, {0.09, 0.008, 0.25}, 1.0, Mean::kLevelAndDrift},
      {"fast_and_at_rest", {"white_noise", "gauss_markov"}, {0.004, 20.0, 0.25}, 0.01, Mean::kLevel},
      {"two", {"white_noise", "gauss_markov", "gauss_markov"}, {0.02, 0.03, 0.3, 2.0, 0.1}, 0.5, Mean::kLevelAndDrift},
      {"walk", {"white_noise", "gauss_markov", "random_walk"}, {0.09, 0.2, 0.25, 1e-3}, 1.0, Mean::kLevel},
      {"rounded", {"white_noise", "gauss_markov", "quantisation"}, {0.02, 0.1, 0.25, 0.05}, 1.0, Mean::kLevel},
      {"oscillating", {"white_noise", "ar", "random_walk"}, {0.09, 0.9, -0.7, 0.1, 1e-3}, 1.0, Mean::kLevelAndDrift},
      {"bias_instability", {"white_noise", "flicker"}, {0.5, 0.3}, 3.0, Mean::kLevel},
      {"known_mean", {"white_noise", "gauss_markov"}, {0.3, 0.05, 0.1}, 2.0, Mean::kZero},
  };
}

SumModel model_of(const Case& c, Mean mean) {
  std::vector<const Estimable*> processes;
  for (const char* name : c.processes) processes.push_back(&estimable(name));
  return {processes, mean};
}

std::vector<double> inside(const SumModel& model, const std::vector<double>& values) {
  std::vector<double> u;
  for (std::size_t i = 0; i < values.size(); ++i) u.push_back(model.parameter(i).inverse(values[i]));
  return u;
}

/// 300 samples with three holes, on a level and a slope.
StaticSignal record_with_holes(const SampleBlock& block, double interval, bool with_mean, std::uint64_t seed) {
  std::vector<double> y = test::simulate_block(block, 330, seed);
  for (std::size_t i = 0; i < y.size() && with_mean; ++i) y[i] += 9.81 + 1e-3 * static_cast<double>(i);
  std::vector<std::size_t> missing{40, 41, 100};
  for (std::size_t i = 200; i < 227; ++i) missing.push_back(i);
  return without(StaticSignal::regular(y, interval), missing);
}

class EveryCase : public testing::TestWithParam<Case> {
 protected:
  EveryCase()
      : model_(model_of(GetParam(), GetParam().mean)),
        u_(inside(model_, GetParam().values)),
        block_(model_.block(u_, GetParam().interval)),
        record_(record_with_holes(block_, GetParam().interval, GetParam().mean != Mean::kZero, 5)) {}
  SumModel model_;
  std::vector<double> u_;
  SampleBlock block_;
  StaticSignal record_;
};
INSTANTIATE_TEST_SUITE_P(Likelihood, EveryCase, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& c) { return c.param.what; });

struct DenseFit {
  double at_mean;         ///< log-likelihood at the mean that maximises it
  double log_likelihood;  ///< of what is left when a basis of all but the means is taken of the samples
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

DenseFit dense_fit(const test::DenseModel& model, Mean mean) {
  const Eigen::LLT<Eigen::MatrixXd> factor(model.samples);
  const Eigen::MatrixXd X = model.means.leftCols(coefficients(mean));
  DenseFit fit;
  fit.covariance = (X.transpose() * factor.solve(X)).inverse();
  fit.mean = fit.covariance * X.transpose() * factor.solve(model.y);
  const Eigen::VectorXd left = model.y - X * fit.mean;
  const Eigen::MatrixXd L = factor.matrixL();
  const double n = static_cast<double>(left.size());
  fit.at_mean = -0.5 * (n * std::log(2.0 * M_PI) + 2.0 * L.diagonal().array().log().sum() + left.dot(factor.solve(left)));
  // Contrasts: n - m orthonormal combinations of the samples that no mean changes. Their density is the restricted likelihood.
  const Eigen::MatrixXd Q = X.cols() > 0 ? Eigen::MatrixXd(Eigen::HouseholderQR<Eigen::MatrixXd>(X).householderQ())
                                         : Eigen::MatrixXd(Eigen::MatrixXd::Identity(left.size(), left.size()));
  const Eigen::MatrixXd A = Q.rightCols(left.size() - X.cols());
  const Eigen::LLT<Eigen::MatrixXd> of_contrasts(A.transpose() * model.samples * A);
  const Eigen::VectorXd w = A.transpose() * model.y;
  const Eigen::MatrixXd K = of_contrasts.matrixL();
  fit.log_likelihood = -0.5 * ((n - static_cast<double>(X.cols())) * std::log(2.0 * M_PI) +
                               2.0 * K.diagonal().array().log().sum() + w.dot(of_contrasts.solve(w)));
  return fit;
}

TEST_P(EveryCase, EqualsTheDenseMultivariateNormal) {
  const DenseFit expected = dense_fit(test::dense(block_, record_), GetParam().mean);
  const LikelihoodValue value = Likelihood({record_}, model_).value(u_);
  EXPECT_NEAR(value.log_likelihood, expected.log_likelihood, 1e-9 * std::abs(expected.log_likelihood));
  EXPECT_NEAR(value.at_mean, expected.at_mean, 1e-9 * std::abs(expected.at_mean));
  const Eigen::Vector2d per_interval(1.0, GetParam().interval);
  for (Eigen::Index i = 0; i < coefficients(GetParam().mean); ++i) {
    const double sd = std::sqrt(expected.covariance(i, i));
    EXPECT_NEAR(value.means[0].value(i) * per_interval(i), expected.mean(i), 1e-7 * sd) << i;  // rounding of 9.81 in 1e-16 sums
    EXPECT_NEAR(std::sqrt(value.means[0].covariance(i, i)) * per_interval(i), sd, 1e-8 * sd) << i;
  }
}

TEST_P(EveryCase, GradientIsThatOfTheValue) {
  const Likelihood likelihood({record_}, model_);
  const auto value = [&](const Eigen::VectorXd& d) {
    std::vector<double> at = u_;
    for (std::size_t i = 0; i < at.size(); ++i) at[i] += d(static_cast<Eigen::Index>(i));
    return Eigen::VectorXd::Constant(1, likelihood.value(at).log_likelihood).eval();
  };
  // Central differences with step h: h^2/6 of a third derivative of order 100, and 1e-13 of 500 over h.
  const Eigen::MatrixXd expected = test::finite_difference(value, static_cast<int>(u_.size()), 1e-4);
  const LikelihoodSlope slope = likelihood.slope(u_);
  for (Eigen::Index i = 0; i < slope.gradient.size(); ++i) EXPECT_NEAR(slope.gradient(i), expected(0, i), 3e-6) << i;
  EXPECT_NEAR(slope.log_likelihood, likelihood.value(u_).log_likelihood, 1e-9 * std::abs(slope.log_likelihood));
}

TEST_P(EveryCase, MomentsAreThoseOfTheDenseNormal) {
  const test::DenseModel model = test::dense(block_, record_);
  const DenseFit fit = dense_fit(model, GetParam().mean);
  const Eigen::LLT<Eigen::MatrixXd> factor(model.samples);
  const Eigen::VectorXd left = model.y - model.means.leftCols(coefficients(GetParam().mean)) * fit.mean;
  const Eigen::VectorXd x = model.cross * factor.solve(left);
  // The mean is not known: with it vary what is left of the samples, by X, and the states, by G.
  const Eigen::MatrixXd X = model.means.leftCols(coefficients(GetParam().mean));
  const Eigen::MatrixXd G = model.cross * factor.solve(X);
  const Eigen::MatrixXd second = model.states - model.cross * factor.solve(model.cross.transpose()) + x * x.transpose() +
                                 G * fit.covariance * G.transpose();
  const Eigen::Index n = static_cast<Eigen::Index>(record_.length()), s = block_.h.size();

  std::vector<double> memory;
  const Likelihood::Expectation at = Likelihood({record_}, model_).expectation(u_, memory);
  double residual = 0.0;
  Eigen::Index row = 0;
  for (const auto& run : record_.runs)
    for (std::size_t i = 0; i < run.count; ++i, ++row) {
      const auto k = static_cast<Eigen::Index>(run.start + i) * s;
      residual += left(row) * left(row) - 2.0 * left(row) * block_.h.dot(x.segment(k, s)) +
                  (block_.h * second.block(k, k, s, s) * block_.h.transpose()).value();
      if (X.cols() > 0)
        residual += ((X.row(row) - 2.0 * block_.h * G.middleRows(k, s)) * fit.covariance * X.row(row).transpose()).value();
    }
  for (std::size_t t = 0; t < model_.terms().size(); ++t) {
    const auto& term = model_.terms()[t];
    EXPECT_NEAR(at.moments[t].residual, residual, 1e-8 * residual);
    if (term.states == 0) continue;
    const auto sum = [&](Eigen::Index from, Eigen::Index to, Eigen::Index ahead) {
      Eigen::MatrixXd total = Eigen::MatrixXd::Zero(term.states, term.states);
      for (Eigen::Index k = from; k < to; ++k)
        total += second.block((k + ahead) * s + term.state, k * s + term.state, term.states, term.states);
      return total;
    };
    test::expect_near_matrix(at.moments[t].first, sum(0, 1, 0), 1e-7, "first");
    test::expect_near_matrix(at.moments[t].before, sum(0, n - 1, 0), 1e-8, "before");
    test::expect_near_matrix(at.moments[t].after, sum(1, n, 0), 1e-8, "after");
    test::expect_near_matrix(at.moments[t].lagged, sum(0, n - 1, 1), 1e-8, "lagged");
    EXPECT_EQ(at.moments[t].transitions, static_cast<double>(n - 1));
  }
}

TEST_P(EveryCase, InnovationsAreWhiteAndGiveTheLikelihood) {
  const Likelihood likelihood({record_}, model_);
  const std::vector<double> white = likelihood.standardised_innovations(u_, 0);
  ASSERT_EQ(white.size(), record_.values.size());
  double squares = 0.0;
  for (const double e : white) squares += e * e;
  // Dense: L^-1 (y - X b) has the same sum of squares.
  const test::DenseModel model = test::dense(block_, record_);
  const Eigen::LLT<Eigen::MatrixXd> factor(model.samples);
  const Eigen::VectorXd left =
      model.y - model.means.leftCols(coefficients(GetParam().mean)) * dense_fit(model, GetParam().mean).mean;
  EXPECT_NEAR(squares, left.dot(factor.solve(left)), 1e-8 * squares);
}

// From 20 000 samples on, the gain is that of an endless record from the first sample on, and the start is corrected for: the
// last sample adds what its innovation says, and the gradient is that of the filter step by step.
TEST_P(EveryCase, ALongRecordIsReadWithAConstantGain) {
  constexpr std::size_t kLong = 20000;
  const SumModel model = model_of(GetParam(), Mean::kZero);
  std::vector<double> y = test::simulate_block(block_, kLong, 7);
  const auto first = [&](std::size_t n) {
    return Likelihood({StaticSignal::regular({y.begin(), y.begin() + static_cast<std::ptrdiff_t>(n)}, GetParam().interval)},
                      model);
  };
  const double added = first(kLong).value(u_).log_likelihood - first(kLong - 1).value(u_).log_likelihood;
  const double w = first(kLong).standardised_innovations(u_, 0).back();
  const StaticSignal record = StaticSignal::regular(y, GetParam().interval);
  y.back() += 1.0;
  const double root_S = 1.0 / (first(kLong).standardised_innovations(u_, 0).back() - w);
  EXPECT_NEAR(added, -0.5 * (std::log(2.0 * M_PI) + w * w) - std::log(root_S), 1e-6);

  const Likelihood likelihood({record}, model_);
  const LikelihoodSlope steps = likelihood.slope(u_);
  const LikelihoodSlope constant = likelihood.slope(u_, steps.information);
  EXPECT_EQ(constant.information, steps.information);
  for (Eigen::Index i = 0; i < steps.gradient.size(); ++i)
    EXPECT_NEAR(constant.gradient(i), steps.gradient(i), 1e-7 * std::sqrt(steps.information(i, i))) << i;
}

// The block of means of m samples against the samples themselves: covariances of the dense normal, averaged.
TEST_P(EveryCase, BlockMeansAreAveragesOfSamples) {
  const bool approximate = std::string(GetParam().what) == "oscillating";  // autoregressions are taken as white
  const std::size_t m = 7, blocks = 12;
  const auto grid = [](std::size_t n) { return StaticSignal::regular(std::vector<double>(n, 0.0), 1.0); };
  for (const double slower : {1.0, 1e-3, 1e-6}) {  // of the interval, so that rates times it go through all sizes
    const double interval = GetParam().interval * slower;
    const Eigen::MatrixXd fine = test::dense(model_.block(u_, interval), grid(m * blocks)).samples;
    Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(blocks, m * blocks);
    for (std::size_t i = 0; i < blocks; ++i)
      mean.row(static_cast<Eigen::Index>(i)).segment(static_cast<Eigen::Index>(i * m), m).setConstant(1.0 / m);
    const auto coarse_at = [&](const std::vector<double>& u) {
      return test::dense(model_.block(u, SampleStep(interval, m)), grid(blocks)).samples;
    };
    // Of flicker's processes with more than 12 correlation times in a block what neighbours share is left out: 1/23 of a
    // variance that is itself 1/12 of a process, and an eighth of all.
    const double tolerance = std::string(GetParam().what) == "bias_instability" ? 1e-3 : 1e-11;
    if (!approximate)
      test::expect_near_matrix(coarse_at(u_), mean * fine * mean.transpose(), tolerance, "covariance of block means");
  }
  const StaticSignal means = block_means(record_, 4);
  const Likelihood likelihood({means}, model_, 4);
  const auto value = [&](const Eigen::VectorXd& d) {
    std::vector<double> at = u_;
    for (std::size_t i = 0; i < at.size(); ++i) at[i] += d(static_cast<Eigen::Index>(i));
    return Eigen::VectorXd::Constant(1, likelihood.value(at).log_likelihood).eval();
  };
  const Eigen::MatrixXd expected = test::finite_difference(value, static_cast<int>(u_.size()), 1e-4);
  const LikelihoodSlope slope = likelihood.slope(u_);
  for (Eigen::Index i = 0; i < slope.gradient.size(); ++i) EXPECT_NEAR(slope.gradient(i), expected(0, i), 3e-6) << i;
}

TEST(Likelihood, RecordsAddUpAndKeepTheirOwnLevels) {
  const Case c = cases()[0];
  const SumModel model = model_of(c, c.mean);
  const std::vector<double> u = inside(model, c.values);
  const StaticSignal a = record_with_holes(model.block(u, 1.0), 1.0, true, 1);
  const StaticSignal b = record_with_holes(model.block(u, 1.0), 1.0, false, 2);
  const double sum = Likelihood({a}, model).value(u).log_likelihood + Likelihood({b}, model).value(u).log_likelihood;
  const LikelihoodValue both = Likelihood({a, b}, model).value(u);
  EXPECT_NEAR(both.log_likelihood, sum, 1e-10 * std::abs(sum));
  EXPECT_GT(both.means[0].value(0) - both.means[1].value(0), 8.0);
}

TEST(Likelihood, RefusesNoRecordEmptyRecordsAndDifferentIntervals) {
  const SumModel model = model_of(cases()[0], cases()[0].mean);
  EXPECT_THROW(Likelihood({}, model), std::invalid_argument);
  EXPECT_THROW(Likelihood({StaticSignal::regular({}, 1.0)}, model), std::invalid_argument);
  EXPECT_THROW(Likelihood({StaticSignal::regular({1, 2}, 1.0), StaticSignal::regular({1, 2}, 0.5)}, model),
               std::invalid_argument);
}

}  // namespace
}  // namespace coast::noise
