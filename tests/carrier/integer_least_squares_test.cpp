// Against a published example and against trying every integer.

#include "coast/carrier/integer_least_squares.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>
#include <random>

#include "coast/record/error.hpp"

namespace coast::carrier {
namespace {

// de Jonge and Tiberius (1996), The LAMBDA method for integer ambiguity estimation: implementation aspects.
TEST(IntegerLeastSquares, PublishedExample) {
  Eigen::Matrix3d Q;
  Q << 6.290, 5.978, 0.544, 5.978, 6.292, 2.340, 0.544, 2.340, 6.288;
  const IntegerSolutions solved = integer_least_squares(Eigen::Vector3d(5.450, 3.100, 2.970), Q, 2);
  EXPECT_EQ(solved.candidates.col(0), Eigen::Vector3d(5, 3, 4));
  EXPECT_EQ(solved.candidates.col(1), Eigen::Vector3d(6, 4, 4));
  EXPECT_NEAR(solved.squared_norms(0), 0.2183, 5e-5);  // as printed
  EXPECT_NEAR(solved.squared_norms(1), 0.3073, 5e-5);
  EXPECT_NEAR(solved.ratio(), 0.3073 / 0.2183, 1e-3);
}

struct Problem {
  Eigen::VectorXd a;
  Eigen::MatrixXd Q;
};

/// Strongly correlated, as double-differenced ambiguities of a short span are: a few directions are badly known.
Problem random_problem(Eigen::Index n, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-50.0, 50.0);
  Problem p{Eigen::VectorXd(n), 0.01 * Eigen::MatrixXd::Identity(n, n)};
  Eigen::MatrixXd directions(n, 2);
  for (double& v : directions.reshaped()) v = normal(random);
  p.Q += directions * directions.transpose();
  for (double& v : p.a) v = uniform(random);
  return p;
}

/// The two smallest norms by trying every integer about the float values. @param half  of the range tried
std::array<double, 2> exhaustive(const Problem& p, int half) {
  const Eigen::MatrixXd W = p.Q.inverse();
  const Eigen::Index n = p.a.size();
  std::array<double, 2> best{1e300, 1e300};
  Eigen::VectorXd z(n);
  const long side = 2 * half + 1;
  const long all = std::lround(std::pow(static_cast<double>(side), static_cast<double>(n)));
  for (long code = 0; code < all; ++code) {
    long rest = code;
    for (Eigen::Index i = 0; i < n; ++i, rest /= side) z(i) = std::round(p.a(i)) + static_cast<double>(rest % side - half);
    const double norm = (p.a - z).dot(W * (p.a - z));
    if (norm < best[0])
      best = {norm, best[0]};
    else if (norm < best[1])
      best[1] = norm;
  }
  return best;
}

TEST(IntegerLeastSquares, AThousandProblemsAgainstTryingAllIntegers) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Index n = 2 + trial % 2;
    const Problem p = random_problem(n, random);
    const IntegerSolutions solved = integer_least_squares(p.a, p.Q, 2);
    ASSERT_EQ(solved.candidates.cols(), 2);
    // The best lie within sqrt(norm * variance) of the float values: then nothing outside the range tried can be nearer.
    int half = 1;
    for (Eigen::Index i = 0; i < n; ++i)
      half = std::max(half, static_cast<int>(std::ceil(std::sqrt(solved.squared_norms(1) * p.Q(i, i)) + 0.5)));
    const auto expected = exhaustive(p, half);
    EXPECT_NEAR(solved.squared_norms(0), expected[0], 1e-9 * (1.0 + expected[0])) << trial;
    EXPECT_NEAR(solved.squared_norms(1), expected[1], 1e-9 * (1.0 + expected[1])) << trial;
    const Eigen::VectorXd off = p.a - solved.candidates.col(0);
    EXPECT_NEAR(off.dot(p.Q.inverse() * off), expected[0], 1e-9 * (1.0 + expected[0])) << trial;
  }
}

// Of uncorrelated ambiguities rounding is best, and its success rate is a product of erf.
TEST(IntegerLeastSquares, UncorrelatedIsRounding) {
  const Eigen::Vector4d sd(0.1, 0.3, 0.2, 0.05);
  const IntegerSolutions solved =
      integer_least_squares(Eigen::Vector4d(1e9 + 0.2, -3.4, 7.1, 0.49), sd.cwiseAbs2().asDiagonal().toDenseMatrix(), 3);
  EXPECT_EQ(solved.candidates.col(0), Eigen::Vector4d(1e9, -3, 7, 0));
  double rate = 1.0;
  for (const double s : sd) rate *= std::erf(0.5 / (s * std::sqrt(2.0)));
  EXPECT_NEAR(solved.success_rate, rate, 1e-12);
}

// Monte Carlo: the share of right integers is at least the bootstrapped success rate, within its sampling error.
TEST(IntegerLeastSquares, SuccessRateIsALowerBound) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d Q;
  Q << 0.290, 0.278, 0.044, 0.278, 0.292, 0.040, 0.044, 0.040, 0.088;
  const Eigen::Matrix3d root = Q.llt().matrixL();
  int right = 0;
  double rate = 0.0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
    const IntegerSolutions solved = integer_least_squares(root * noise, Q, 1);
    rate = solved.success_rate;
    if (solved.candidates.col(0).isZero()) ++right;
  }
  EXPECT_GT(rate, 0.5);
  EXPECT_GT(static_cast<double>(right) / kTrials, rate - 4.0 * std::sqrt(rate * (1.0 - rate) / kTrials));
}

TEST(IntegerLeastSquares, Refuses) {
  EXPECT_THROW(static_cast<void>(integer_least_squares(Eigen::Vector2d(0, 0), Eigen::Matrix3d::Identity())),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(integer_least_squares(Eigen::Vector2d(0, 0), Eigen::Matrix2d::Constant(1.0))), NumericalError);
}

}  // namespace
}  // namespace coast::carrier
