#pragma once
// Sparse symmetric positive definite systems: solution, log determinant, and the elements of the inverse on the pattern of the
// factor.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <memory>
#include <span>

namespace coast::estimate {

/// Lower triangle of a symmetric matrix, row by row: CHOLMOD uses this format without a copy; stored by columns it would be
/// copied.
using LowerTriangle = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Elements of the inverse of a symmetric positive definite matrix on the pattern of its Cholesky factor, which contains that
/// of the matrix itself: the covariance of any two unknowns coupled in the matrix is available.
class SelectedInverse {
 public:
  /// Element (i, j) = (j, i), found by bisection.
  /// @throws std::out_of_range  (i, j) is not in the pattern
  [[nodiscard]] double operator()(Eigen::Index i, Eigen::Index j) const;

  /// The symmetric block of these rows and columns, in their order.
  /// @throws std::out_of_range  one of its elements is not in the pattern
  [[nodiscard]] Eigen::MatrixXd block(std::span<const Eigen::Index> rows) const;

 private:
  friend class SparseCholesky;
  SelectedInverse() = default;

  std::shared_ptr<const void> factor_;  // its memory holds the elements of the inverse
  std::span<const int> starts_, rows_;  // of the columns, in elimination order
  std::span<const double> values_;
  Eigen::VectorXi position_;  // of every row in that order
};

/// P A P' = L L' of a sparse symmetric positive definite A, by CHOLMOD (Chen, Davis, Hager & Rajamanickam 2008, ACM TOMS
/// 35:22). Simplicial, without dense blocks: no BLAS is called, so results do not depend on the installed BLAS.
/// @note  Const functions share CHOLMOD's workspace: only one thread at a time may use an object. A moved-from one can only be
///        destroyed or assigned to.
class SparseCholesky {
 public:
  /// Chooses the elimination order P and analyses L once for all factorizations. Natural order if it causes no fill-in (a chain
  /// with the border last), else natural or approximate minimum degree, whichever gives less fill-in.
  /// @param lower  compressed; only its pattern is used; an upper triangle is ignored
  /// @throws std::invalid_argument  not square, not compressed
  explicit SparseCholesky(const LowerTriangle& lower);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// @param lower  the pattern of the constructor, stored zeros included
  /// @throws NumericalError  not positive definite, or not finite; names the column at which elimination stopped. There is no
  ///                         factor afterwards.
  /// @throws std::invalid_argument  another pattern
  void factorize(const LowerTriangle& lower);

  /// A^-1 b. This and the following functions need a factor: @throws std::logic_error  there is none
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  [[nodiscard]] double log_determinant() const;

  /// Condition number of A with its unknowns scaled so that the diagonal is one: largest over smallest eigenvalue, by power
  /// iterations with L L' and its inverse until they change by less than a percent (at most `most` of each). They converge from
  /// below. The error of a solution by normal equations, in standard deviations, is some 1e-17 to 1e-16 times this.
  [[nodiscard]] double condition(int most = 30) const;

  /// Elements of A^-1 on the pattern of L + L' by the recursion of Takahashi, Fagan & Chen (1973) and Erisman & Tinney (1975,
  /// CACM 18:177), column by column from the last to the first. With the unit factor l_kj = L_kj / L_jj,
  ///
  ///     Z_ij = - sum_{k > j} Z_ik l_kj,   i > j,        Z_jj = 1 / L_jj^2 - sum_{k > j} l_kj Z_kj
  ///
  /// i and k over the pattern of column j of L: the sums stay inside the pattern of L. About as many operations as the
  /// factorization: the sum of the squared lengths of its columns. The inverse overwrites L: there is no factor afterwards.
  [[nodiscard]] SelectedInverse invert();

  /// Number of entries of L, diagonal included; known from the analysis.
  [[nodiscard]] std::size_t factor_entries() const;

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
};

}  // namespace coast::estimate
