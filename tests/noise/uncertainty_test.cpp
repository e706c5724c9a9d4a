#include "coast/noise/uncertainty.hpp"

#include <gtest/gtest.h>

#include "noise/static_record.hpp"
#include "support/support.hpp"

namespace coast::noise {
namespace {

using test::logs;

using test::sum;

// I_ij = tr(P V_i P V_j)/2 with P = V^-1 - V^-1 X (X' V^-1 X)^-1 X' V^-1 (Harville 1977), V_i by central differences.
Eigen::MatrixXd dense_information(const SumModel& model, const std::vector<double>& u, double interval, std::size_t n) {
  const StaticSignal grid = StaticSignal::regular(std::vector<double>(n, 0.0), interval);
  const auto at = [&](const std::vector<double>& v) { return test::dense(model.block(v, interval), grid); };
  const test::DenseModel here = at(u);
  const Eigen::MatrixXd W = here.samples.inverse();
  const Eigen::MatrixXd X = here.means.leftCols(coefficients(model.mean()));
  Eigen::MatrixXd P = W;
  if (X.cols() > 0) P -= W * X * (X.transpose() * W * X).inverse() * X.transpose() * W;
  std::vector<Eigen::MatrixXd> PV;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double step = 1e-4;
    std::vector<double> above = u, below = u;
    above[i] += step;
    below[i] -= step;
    PV.emplace_back(P * (at(above).samples - at(below).samples) / (2.0 * step));
  }
  Eigen::MatrixXd information(static_cast<Eigen::Index>(u.size()), static_cast<Eigen::Index>(u.size()));
  for (std::size_t i = 0; i < u.size(); ++i)
    for (std::size_t j = 0; j < u.size(); ++j)
      information(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = 0.5 * (PV[i] * PV[j]).trace();
  return information;
}

TEST(Information, EqualsTheDenseOneWhateverIsEstimatedOfTheMean) {
  for (const Mean mean : {Mean::kZero, Mean::kLevel, Mean::kLevelAndDrift}) {
    const SumModel model = sum({"white_noise", "gauss_markov", "random_walk", "quantisation", "ar"}, mean);
    std::vector<double> u = logs({0.09, 0.05, 0.25, 1e-3, 0.02});
    u.insert(u.end(), {0.8, -0.4, std::log(0.05)});
    const Eigen::MatrixXd expected = dense_information(model, u, 1.0, 250);
    // The prior of the mean, 1e7 variances; of the dense one, steps of 1e-4.
    test::expect_near_matrix(expected_information(model, u, 1.0, 250), expected, 3e-6, "information");
  }
}

// The bounds of an independent computation (exact Gaussian information): N = 6000, dt = 1 s, level and drift estimated.
TEST(Information, BoundsOfThePublishedCase) {
  const auto bounds = [](const SumModel& model, const std::vector<double>& values) {
    const Eigen::MatrixXd covariance = cramer_rao(expected_information(model, logs(values), 1.0, 6000));
    std::vector<double> sd;
    for (std::size_t i = 0; i < values.size(); ++i)
      sd.push_back(values[i] * std::sqrt(covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i))));
    return sd;
  };
  const auto without = bounds(sum({"white_noise", "gauss_markov"}, Mean::kLevelAndDrift), {0.09, 0.008, 0.25});
  EXPECT_NEAR(without[0], 0.0019, 5e-5);  // half of the last digit published
  EXPECT_NEAR(without[1], 0.0019, 5e-5);
  EXPECT_NEAR(without[2], 0.055, 5e-4);
  const auto with =
      bounds(sum({"white_noise", "gauss_markov", "random_walk"}, Mean::kLevelAndDrift), {0.09, 0.008, 0.25, 1e-8});
  EXPECT_NEAR(with[1], 0.0023, 5e-5);
  EXPECT_NEAR(with[2], 0.071, 5e-4);
  EXPECT_NEAR(with[3], 9.5e-5, 5e-7);
}

// Three hours at 100 Hz of two Gauss-Markov processes, exact dense values of an independent computation.
TEST(Information, BoundsOfThreeHoursOnBlockMeans) {
  const std::vector<double> u = logs({3.6e-7, 4e-4, 4e-8, 0.1, 1e-8});
  struct Published {
    Mean mean;
    double beta, sigma2;
  };
  for (const Published& p :
       {Published{Mean::kLevel, 1.09, 0.96}, Published{Mean::kLevelAndDrift, 1.74, 1.56}, Published{Mean::kZero, 0.72, 0.62}}) {
    const Eigen::MatrixXd covariance =
        cramer_rao(expected_information(sum({"white_noise", "gauss_markov", "gauss_markov"}, p.mean), u, 0.01, 1080000));
    EXPECT_NEAR(std::sqrt(covariance(1, 1)), p.beta, 0.012 * p.beta);  // a hundredth lost on blocks, and the last digit
    EXPECT_NEAR(std::sqrt(covariance(2, 2)), p.sigma2, 0.012 * p.sigma2);
    if (p.mean == Mean::kLevel) {
      EXPECT_NEAR(covariance(1, 2) / std::sqrt(covariance(1, 1) * covariance(2, 2)), -0.94, 0.006);
      EXPECT_NEAR(std::sqrt(covariance(3, 3)), 0.46, 0.01);
      EXPECT_NEAR(std::sqrt(covariance(4, 4)), 0.27, 0.01);
    }
  }
}

TEST(Information, NothingKnownIsInfinite) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information(0, 0) = 4.0;
  const Eigen::MatrixXd covariance = cramer_rao(information);
  EXPECT_EQ(covariance(0, 0), 0.25);
  EXPECT_TRUE(std::isinf(covariance(1, 1)));
}

TEST(ProfileInterval, OfAVarianceAloneIsThatOfItsLikelihoodRatio) {
  const SumModel model = sum({"white_noise"}, Mean::kZero);
  const StaticSignal record = StaticSignal::regular(test::simulate_block(model.block(logs({4.0}), 1.0), 150, 3), 1.0);
  const Likelihood likelihood({record}, model);
  const Fit fit = fit_maximum_likelihood(likelihood, logs({1.0}));
  const ProfileInterval interval = profile_intervals(likelihood, fit)[0];
  ASSERT_TRUE(interval.lower && interval.upper);
  // 2 (max - l) = n (exp(-d) + d - 1) for d = u - u_max; its root is met to 0.01 in the root of 1.96.
  for (const double u : {*interval.lower, *interval.upper}) {
    const double d = u - fit.u[0];
    EXPECT_NEAR(std::sqrt(150.0 * (std::exp(-d) + d - 1.0)), 1.96, 0.011);
  }
}

TEST(ProfileInterval, IsOpenWhereTheRecordSaysNothing) {
  const SumModel model = sum({"white_noise", "gauss_markov", "random_walk"}, Mean::kLevel);
  const StaticSignal record =
      StaticSignal::regular(test::simulate_block(model.block(logs({0.09, 0.008, 0.25, 1e-10}), 1.0), 3000, 12), 1.0);
  const Likelihood likelihood({record}, model);
  const Fit fit = fit_maximum_likelihood(likelihood, logs({0.09, 0.01, 0.2, 1e-6}));
  const ProfileInterval walk = profile_intervals(likelihood, fit)[3];
  EXPECT_FALSE(walk.lower.has_value());  // the walk may be zero
  ASSERT_TRUE(walk.upper.has_value());
  EXPECT_GT(*walk.upper, std::log(1e-10));
}

TEST(MeanInterval, OfWhiteNoiseIsStudents) {
  constexpr std::size_t kSamples = 12;
  const SumModel model = sum({"white_noise"}, Mean::kLevel);
  const StaticSignal record = StaticSignal::regular(test::simulate_block(model.block(logs({4.0}), 1.0), kSamples, 3), 1.0);
  const Likelihood likelihood({record}, model);
  const ProfileInterval interval = mean_intervals(likelihood, fit_maximum_likelihood(likelihood, logs({1.0})))[0][0];
  ASSERT_TRUE(interval.lower && interval.upper);
  double mean = 0.0;
  for (const double y : record.values) mean += y / kSamples;
  double squares = 0.0;
  for (const double y : record.values) squares += (y - mean) * (y - mean);
  // 2 (max - l) = (n - 1) log(1 + n d^2 / squares); its root is met to 0.01 in the root of 1.96.
  for (const double at : {*interval.lower, *interval.upper}) {
    const double d = at - mean;
    EXPECT_NEAR(std::sqrt((kSamples - 1.0) * std::log1p(kSamples * d * d / squares)), 1.96, 0.011);
  }
}

/// The restricted log-likelihood of a Gauss-Markov process in white noise with the level held, by dense matrices, maximised
/// over a grid of beta and both variances about the estimate.
double dense_profile(const std::vector<double>& values, double level, const std::vector<double>& about,
                     const std::vector<Interval>& ranges) {
  const auto n = static_cast<Eigen::Index>(values.size());
  const Eigen::VectorXd r = Eigen::Map<const Eigen::VectorXd>(values.data(), n).array() - level;
  constexpr int kHalf = 12;
  constexpr double kStep = 0.3;  // of logarithms: a parabola through the best three leaves less than 0.01
  const auto value = [&](double noise, double beta, double variance) {
    Eigen::MatrixXd V(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        V(i, j) = variance * std::exp(-beta * std::abs(static_cast<double>(i - j))) + (i == j ? noise : 0.0);
    const Eigen::LLT<Eigen::MatrixXd> llt(V);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
    const double information = ones.dot(llt.solve(ones));
    const double log_determinant = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
    return -0.5 * (log_determinant + r.dot(llt.solve(r)) + std::log(information));
  };
  double best = -1e300;
  for (int i = -3; i <= 3; ++i)
    for (int j = -kHalf; j <= kHalf; ++j)
      for (int k = -kHalf; k <= kHalf; ++k) {
        const auto at = [&](std::size_t p, double off) {
          return std::exp(std::clamp(about[p] + off, ranges[p].lower, ranges[p].upper));
        };
        best = std::max(best, value(at(0, 0.5 * kStep * i), at(1, kStep * j), at(2, kStep * k)));
      }
  return best;
}

// A grid misses the top by at most the curvature over half a step: information of order one in slow directions (0.15^2/2) and
// of n/2 in that of white noise (0.075^2/2 * 20): 0.1 at both ends of the comparison.
TEST(MeanInterval, IsWhereDenseMatricesHaveIt) {
  const SumModel model = sum({"white_noise", "gauss_markov"}, Mean::kLevel);
  const StaticSignal record = StaticSignal::regular(test::simulate_block(model.block(logs({0.05, 0.1, 1.0}), 1.0), 40, 8), 1.0);
  const Likelihood likelihood({record}, model);
  const Fit fit = fit_maximum_likelihood(likelihood, logs({0.05, 0.1, 1.0}));
  const MeanEstimate mean = likelihood.value(fit.u).means.front();
  const ProfileInterval interval = mean_intervals(likelihood, fit)[0][0];
  ASSERT_TRUE(interval.lower && interval.upper);
  const double normal = 1.96 * std::sqrt(mean.covariance(0, 0));
  EXPECT_GT(*interval.upper - *interval.lower, 2.0 * normal);  // badly known processes make it wider
  const std::vector<Interval> ranges = model.ranges(likelihood.scale());
  const double top = dense_profile(record.values, mean.value(0), fit.u, ranges);
  EXPECT_NEAR(top - dense_profile(record.values, *interval.lower, fit.u, ranges), 1.92, 0.12);
  EXPECT_NEAR(top - dense_profile(record.values, *interval.upper, fit.u, ranges), 1.92, 0.12);
}

TEST(ChiBarSquare, IsHalfAChiSquare) {
  EXPECT_NEAR(chi_bar_square_survival(2.705543454), 0.05, 1e-9);  // the 90 % quantile of chi2(1), standard tables
  EXPECT_EQ(chi_bar_square_survival(0.0), 1.0);
}

}  // namespace
}  // namespace coast::noise
