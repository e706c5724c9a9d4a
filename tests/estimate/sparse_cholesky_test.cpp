// The sparse factor and the elements of the inverse against dense algebra; one long chain by its residuals.

#include "coast/estimate/sparse_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "coast/record/error.hpp"
#include "support/spectra.hpp"

namespace coast {
namespace {

using namespace estimate;

static_assert(!std::is_copy_constructible_v<SparseCholesky> && std::is_nothrow_move_constructible_v<SparseCholesky>);

using Clique = Eigen::VectorX<Eigen::Index>;  // unknowns that are observed together

/// Sum of J' J over the cliques, one square J of standard normal elements each: lower triangle.
LowerTriangle lower_of_cliques(Eigen::Index n, const std::vector<Clique>& cliques, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<Eigen::Triplet<double>> elements;
  for (const Clique& clique : cliques) {
    const Eigen::MatrixXd J = Eigen::MatrixXd::NullaryExpr(clique.size(), clique.size(), [&] { return normal(random); });
    const Eigen::MatrixXd JtJ = J.transpose() * J;
    for (Eigen::Index b = 0; b < clique.size(); ++b)
      for (Eigen::Index a = 0; a < clique.size(); ++a)
        if (clique(a) >= clique(b)) elements.emplace_back(clique(a), clique(b), JtJ(a, b));
  }
  LowerTriangle lower(n, n);
  lower.setFromTriplets(elements.begin(), elements.end());
  return lower;
}

Clique counted(Eigen::Index size, Eigen::Index first) {
  return Clique::LinSpaced(size, first, first + size - 1);
}

/// Links tied to the next and all to a border at the end.
std::vector<Clique> chain_cliques(Eigen::Index links, Eigen::Index size, Eigen::Index border) {
  std::vector<Clique> cliques;
  for (Eigen::Index link = 0; link + 1 < links; ++link) {
    Clique clique(2 * size + border);
    clique << counted(2 * size, link * size), counted(border, links * size);
    cliques.push_back(clique);
  }
  return cliques;
}

/// Every unknown for itself, and triples that are drawn.
std::vector<Clique> scattered_cliques(Eigen::Index n, int triples, std::mt19937_64& random) {
  std::vector<Clique> cliques;
  for (Eigen::Index i = 0; i < n; ++i) cliques.push_back(counted(1, i));
  std::uniform_int_distribution<Eigen::Index> unknown(0, n - 1);
  while (triples-- > 0) {
    const Eigen::Index first = unknown(random);
    cliques.emplace_back(
        Eigen::Vector3<Eigen::Index>(first, (first + 1 + unknown(random) % (n / 2)) % n, (first + n / 2 + 1) % n));
  }
  return cliques;
}

/// The same matrix with its unknowns counted from the end.
LowerTriangle turned_round(const LowerTriangle& lower) {
  const Eigen::Index last = lower.rows() - 1;
  std::vector<Eigen::Triplet<double>> elements;
  for (Eigen::Index r = 0; r < lower.rows(); ++r)
    for (LowerTriangle::InnerIterator e(lower, r); e; ++e) elements.emplace_back(last - e.col(), last - e.row(), e.value());
  LowerTriangle turned(lower.rows(), lower.cols());
  turned.setFromTriplets(elements.begin(), elements.end());
  return turned;
}

/// Dense counterpart. Backward stable algorithms of n columns are off by n eps times the condition number at most, of the
/// norm of their result; both sides are.
struct DenseReference {
  explicit DenseReference(const LowerTriangle& lower) : A(Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>()), ldlt(A) {
    const Eigen::VectorXd eigenvalues = test::eigenvalues(A);
    const auto n = static_cast<double>(A.rows());
    inverse = ldlt.solve(Eigen::MatrixXd::Identity(A.rows(), A.cols()));
    tolerance = 2.0 * n * std::numeric_limits<double>::epsilon() * eigenvalues.maxCoeff() / eigenvalues.minCoeff();
  }
  Eigen::MatrixXd A, inverse;
  Eigen::LDLT<Eigen::MatrixXd> ldlt;
  double tolerance;  ///< relative
};

/// Solution, determinant, and all elements of the inverse that there are, which takes the factor; how many there are.
std::size_t expect_like_dense(SparseCholesky& factor, const LowerTriangle& lower) {
  const DenseReference dense(lower);
  EXPECT_LT(dense.tolerance, 1e-6) << "too ill-conditioned to show anything";
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(lower.rows(), -1.0, 2.0);
  const Eigen::VectorXd x = dense.ldlt.solve(b);
  EXPECT_LT((factor.solve(b) - x).norm(), dense.tolerance * x.norm());
  EXPECT_NEAR(factor.log_determinant(), dense.ldlt.vectorD().array().log().sum(), dense.tolerance);

  const SelectedInverse inverse = factor.invert();
  const double largest = dense.tolerance * dense.inverse.norm();
  std::size_t selected = 0;
  for (Eigen::Index j = 0; j < lower.cols(); ++j) {
    for (Eigen::Index i = j; i < lower.rows(); ++i) {
      try {
        EXPECT_NEAR(inverse(i, j), dense.inverse(i, j), largest) << i << ", " << j;
        EXPECT_EQ(inverse(i, j), inverse(j, i));
        ++selected;
      } catch (const std::out_of_range&) {
        EXPECT_EQ(dense.A(i, j), 0.0) << "in the matrix, so it should be there: " << i << ", " << j;
      }
    }
  }
  EXPECT_EQ(selected, factor.factor_entries());
  return selected;
}

TEST(SparseCholesky, ChainIsFactoredInItsOwnOrderWithoutFill) {
  std::mt19937_64 random(1);
  const std::vector<Clique> cliques = chain_cliques(12, 5, 4);
  const LowerTriangle lower = lower_of_cliques(64, cliques, random);
  SparseCholesky factor(lower);
  factor.factorize(lower);
  EXPECT_EQ(expect_like_dense(factor, lower), static_cast<std::size_t>(lower.nonZeros()));

  factor.factorize(lower);
  const SelectedInverse inverse = factor.invert();
  const Eigen::MatrixXd dense = DenseReference(lower).inverse;
  const std::vector<Eigen::Index> rows{63, 17, 15, 20, 60};  // out of order, over two links and the border
  EXPECT_LT((inverse.block(rows) - dense(rows, rows)).norm(), 1e-9 * dense.norm());
}

TEST(SparseCholesky, ScatteredPatterns) {
  std::mt19937_64 random(2);
  for (const int triples : {0, 10, 40, 150}) {
    const LowerTriangle lower = lower_of_cliques(90, scattered_cliques(90, triples, random), random);
    SparseCholesky factor(lower);
    factor.factorize(lower);
    EXPECT_GE(expect_like_dense(factor, lower), static_cast<std::size_t>(lower.nonZeros()));
  }
}

TEST(SparseCholesky, DenseMatrices) {
  std::mt19937_64 random(3);
  for (const Eigen::Index n : {1, 2, 7, 30}) {
    const LowerTriangle lower = lower_of_cliques(n, {counted(n, 0)}, random);
    SparseCholesky factor(lower);
    factor.factorize(lower);
    EXPECT_EQ(expect_like_dense(factor, lower), static_cast<std::size_t>(n * (n + 1) / 2));
  }
}

// An arrow with its head first fills up in natural order.
TEST(SparseCholesky, BorderFirstIsReordered) {
  std::mt19937_64 random(4);
  const LowerTriangle lower = lower_of_cliques(123, chain_cliques(60, 2, 3), random);
  const LowerTriangle turned = turned_round(lower);
  SparseCholesky factor(lower), turned_factor(turned);
  factor.factorize(lower);
  turned_factor.factorize(turned);
  EXPECT_EQ(turned_factor.factor_entries(), factor.factor_entries()) << "natural order would fill all 7626";
  const DenseReference dense(lower);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(123, -1.0, 2.0);
  const Eigen::VectorXd x = factor.solve(b);
  EXPECT_LT((turned_factor.solve(b.reverse()).reverse() - x).norm(), dense.tolerance * x.norm());
  EXPECT_NEAR(turned_factor.log_determinant(), factor.log_determinant(), dense.tolerance);
  const SelectedInverse inverse = factor.invert();
  expect_like_dense(turned_factor, turned);
  turned_factor.factorize(turned);
  const SelectedInverse turned_inverse = turned_factor.invert();
  for (Eigen::Index i = 0; i < 123; ++i)
    for (LowerTriangle::InnerIterator e(lower, i); e; ++e)
      EXPECT_NEAR(turned_inverse(122 - i, 122 - e.col()), inverse(i, e.col()), dense.tolerance * dense.inverse.norm());
}

// Leaves of three entries whose rows lie far apart in long columns: there the rows are bisected.
TEST(SparseCholesky, ShortColumnsBesideLongOnes) {
  std::mt19937_64 random(5);
  std::vector<Clique> cliques{counted(120, 40)};
  for (Eigen::Index leaf = 0; leaf < 40; ++leaf)
    cliques.emplace_back(Eigen::Vector3<Eigen::Index>(leaf, 40 + leaf, 159 - leaf));
  const LowerTriangle lower = lower_of_cliques(160, cliques, random);
  SparseCholesky factor(lower);
  factor.factorize(lower);
  EXPECT_EQ(expect_like_dense(factor, lower), static_cast<std::size_t>(lower.nonZeros()));
}

TEST(SparseCholesky, NewValuesInTheSamePattern) {
  std::mt19937_64 random(6);
  const std::vector<Clique> cliques = scattered_cliques(50, 40, random);
  const LowerTriangle first = lower_of_cliques(50, cliques, random);
  const LowerTriangle second = lower_of_cliques(50, cliques, random);
  SparseCholesky factor(first);
  factor.factorize(first);
  const SelectedInverse of_first = factor.invert();
  const double kept = of_first(7, 7);
  factor.factorize(second);
  expect_like_dense(factor, second);
  EXPECT_EQ(of_first(7, 7), kept) << "an inverse stands for itself";

  factor.factorize(second);
  SparseCholesky moved = std::move(factor);
  const Eigen::VectorXd x = moved.solve(Eigen::VectorXd::Ones(50));
  SparseCholesky fresh(second);
  fresh.factorize(second);
  EXPECT_EQ(fresh.solve(Eigen::VectorXd::Ones(50)), x) << "what was factorized before leaves no trace";
  moved = SparseCholesky(first);
  moved.factorize(first);
  EXPECT_EQ(moved.invert()(7, 7), kept);
}

// Zeros in the pattern, even whole blocks of them, are elements like others.
TEST(SparseCholesky, StoredZerosStayInThePattern) {
  std::mt19937_64 random(7);
  LowerTriangle lower = lower_of_cliques(34, chain_cliques(10, 3, 4), random);
  SparseCholesky factor(lower);
  for (Eigen::Index r = 0; r < 34; ++r)
    for (LowerTriangle::InnerIterator e(lower, r); e; ++e)
      if (e.col() != r && (e.col() < 12 || e.col() / 3 != r / 3)) e.valueRef() = 0.0;
  factor.factorize(lower);
  EXPECT_EQ(expect_like_dense(factor, lower), static_cast<std::size_t>(lower.nonZeros()));
  factor.factorize(lower);
  EXPECT_EQ(factor.invert()(4, 1), 0.0);
  EXPECT_THROW((void)factor.solve(Eigen::VectorXd::Ones(34)), std::logic_error) << "the inverse is where the factor was";
}

TEST(SparseCholesky, OutsideThePatternIsNamed) {
  std::mt19937_64 random(8);
  const LowerTriangle lower = lower_of_cliques(22, chain_cliques(10, 2, 2), random);
  SparseCholesky factor(lower);
  factor.factorize(lower);
  const SelectedInverse inverse = factor.invert();
  EXPECT_THROW((void)inverse(0, 10), std::out_of_range);
  EXPECT_THROW((void)inverse(10, 0), std::out_of_range);
  EXPECT_THROW((void)inverse(-1, 0), std::out_of_range);
  EXPECT_THROW((void)inverse(0, 22), std::out_of_range);
  EXPECT_THROW((void)inverse.block(std::vector<Eigen::Index>{0, 2, 10}), std::out_of_range);
  EXPECT_EQ(inverse.block({}).size(), 0);
}

/// What is said where the diagonal element of column 13 is bad.
std::string said_of_column_13(SparseCholesky& factor, LowerTriangle lower, double bad_value) {
  lower.coeffRef(13, 13) = bad_value;
  try {
    factor.factorize(lower);
  } catch (const NumericalError& error) {
    return error.what();
  }
  return "";
}

// In the caller's numbers also where they are not the order of elimination.
TEST(SparseCholesky, NotPositiveDefiniteNamesTheColumn) {
  std::mt19937_64 random(9);
  const LowerTriangle chain = lower_of_cliques(22, chain_cliques(10, 2, 2), random);
  SparseCholesky in_order(chain);
  EXPECT_EQ(said_of_column_13(in_order, chain, -1.0),
            "matrix is not positive definite at column 13: its pivot is not a positive number; 13 of 22 columns are eliminated "
            "before it");

  const LowerTriangle good = turned_round(chain);
  SparseCholesky factor(good);
  using Limits = std::numeric_limits<double>;
  for (const double bad_value : {-1e-3, 0.0, Limits::quiet_NaN(), Limits::infinity()}) {
    factor.factorize(good);
    const std::string said = said_of_column_13(factor, good, bad_value);
    EXPECT_NE(said.find("column 13:"), std::string::npos) << bad_value << ": " << said;
    EXPECT_EQ(said.find("13 of 22"), std::string::npos) << "in its own order: " << said;
    EXPECT_THROW((void)factor.solve(Eigen::VectorXd::Ones(22)), std::logic_error);
  }
  factor.factorize(good);
  expect_like_dense(factor, good);
}

TEST(SparseCholesky, BrokenContracts) {
  std::mt19937_64 random(10);
  const LowerTriangle lower = lower_of_cliques(22, chain_cliques(10, 2, 2), random);
  SparseCholesky factor(lower);
  EXPECT_THROW((void)factor.solve(Eigen::VectorXd::Ones(22)), std::logic_error);
  EXPECT_THROW((void)factor.log_determinant(), std::logic_error);
  EXPECT_THROW((void)factor.invert(), std::logic_error);
  EXPECT_THROW(factor.factorize(lower_of_cliques(22, scattered_cliques(22, 5, random), random)), std::invalid_argument);
  factor.factorize(lower);
  EXPECT_THROW((void)factor.solve(Eigen::VectorXd::Ones(21)), std::invalid_argument);
  EXPECT_THROW(SparseCholesky(LowerTriangle(3, 2)), std::invalid_argument);
}

// Unknowns in units a factor of 1e4 apart: scaled back by the diagonal they have the condition number of before.
TEST(SparseCholesky, ConditionIsThatOfTheScaledMatrix) {
  std::mt19937_64 random(12);
  for (const bool turned : {false, true}) {
    LowerTriangle lower = lower_of_cliques(124, chain_cliques(24, 5, 4), random);
    if (turned) lower = turned_round(lower);
    const Eigen::VectorXd units =
        Eigen::VectorXd::LinSpaced(124, -2.0, 2.0).unaryExpr([](double e) { return std::pow(10.0, e); });
    lower = (units.asDiagonal() * lower * units.asDiagonal()).eval();
    const Eigen::MatrixXd A = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
    const Eigen::VectorXd s = A.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd eigenvalues = test::eigenvalues(s.asDiagonal() * A * s.asDiagonal());
    const double condition = eigenvalues.maxCoeff() / eigenvalues.minCoeff();
    SparseCholesky factor(lower);
    factor.factorize(lower);
    // It stops where a step gains 1 %; what is missing then is the largest eigenvalue's, whose neighbours are near.
    EXPECT_GT(factor.condition(), 0.7 * condition);
    EXPECT_LT(factor.condition(), 1.000001 * condition);
  }
}

TEST(SparseCholesky, LongChain) {
  constexpr Eigen::Index kLinks = 20'000, kSize = 6, kBorder = 10, kUnknowns = kLinks * kSize + kBorder;
  std::mt19937_64 random(11);
  const LowerTriangle lower = lower_of_cliques(kUnknowns, chain_cliques(kLinks, kSize, kBorder), random);
  SparseCholesky factor(lower);
  factor.factorize(lower);
  EXPECT_EQ(factor.factor_entries(), static_cast<std::size_t>(lower.nonZeros()));

  const auto A = lower.selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(kUnknowns, -1.0, 1.0);
  const Eigen::VectorXd x = factor.solve(b);
  const Eigen::VectorXd residual = A * x - b;
  EXPECT_LT(residual.norm(), 1e-12 * lower.norm() * x.norm());  // whatever the condition number

  const std::array<Eigen::Index, 4> some{3, kLinks / 2 * kSize, kUnknowns - kBorder - 1, kUnknowns - 1};
  std::vector<Eigen::VectorXd> columns;
  for (const Eigen::Index j : some) columns.push_back(factor.solve(Eigen::VectorXd::Unit(kUnknowns, j)));
  const SelectedInverse inverse = factor.invert();
  for (Eigen::Index i = 0; i < kUnknowns; ++i) EXPECT_GT(inverse(i, i), 0.0) << i;
  for (std::size_t k = 0; k < some.size(); ++k)
    for (LowerTriangle::InnerIterator e(lower, some[k]); e; ++e)
      EXPECT_NEAR(inverse(some[k], e.col()), columns[k](e.col()), 1e-9 * inverse(some[k], some[k])) << e.col();
}

}  // namespace
}  // namespace coast
