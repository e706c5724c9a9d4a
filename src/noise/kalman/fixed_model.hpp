#pragma once
// A sum of processes as matrices of a size known at compile time, for the passes over a record. Private to the room.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "coast/noise/estimable.hpp"

namespace coast::noise {

/// The nonzero elements of a transition: blocks of one or two states. A product costs N operations for each.
template <int N>
class SparseTransition {
 public:
  using Matrix = Eigen::Matrix<double, N, N>;

  explicit SparseTransition(const Matrix& Phi) : whole_(Phi) {
    for (int c = 0; c < N; ++c)
      for (int r = 0; r < N; ++r)
        if (Phi(r, c) != 0.0) elements_[static_cast<std::size_t>(count_++)] = {r, c, Phi(r, c)};
  }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// Phi M
  template <class Columns>
  [[nodiscard]] Columns left(const Columns& M) const {
    if constexpr (N <= kDense) return whole_ * M;
    Columns product = Columns::Zero(M.rows(), M.cols());
    for (Eigen::Index c = 0; c < M.cols(); ++c)
      for (int k = 0; k < count_; ++k) {
        const Element& e = elements_[static_cast<std::size_t>(k)];
        product(e.row, c) += e.value * M(e.col, c);
      }
    return product;
  }
  /// M Phi'
  [[nodiscard]] Matrix right(const Matrix& M) const {
    Matrix product = Matrix::Zero();
    for (int k = 0; k < count_; ++k) {
      const Element& e = elements_[static_cast<std::size_t>(k)];
      product.col(e.row) += e.value * M.col(e.col);
    }
    return product;
  }
  /// Phi S Phi' for a symmetric S.
  [[nodiscard]] Matrix congruence(const Matrix& S) const { return right(right(S).transpose()); }

 private:
  struct Element {
    int row = 0;
    int col = 0;
    double value = 0.0;
  };
  static constexpr int kDense = 4;  // up to this size a full product costs less than finding the elements

  Matrix whole_;
  std::array<Element, static_cast<std::size_t>(N) * N> elements_{};
  int count_ = 0;
};

template <int N>
struct FixedModel {
  using Matrix = Eigen::Matrix<double, N, N>;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Row = Eigen::Matrix<double, 1, N>;

  /// States beyond those of the block are present and always zero.
  explicit FixedModel(const SampleBlock& block) : white(block.white) {
    const Eigen::Index n = block.h.size();
    Phi.topLeftCorner(n, n) = block.Phi;
    Q.topLeftCorner(n, n) = block.Q;
    P_first.topLeftCorner(n, n) = block.P_first;
    h.head(n) = block.h;
    sparse = SparseTransition<N>(Phi);
  }

  Matrix Phi = Matrix::Zero();
  Matrix Q = Matrix::Zero();
  Matrix P_first = Matrix::Zero();
  Row h = Row::Zero();
  SparseTransition<N> sparse{Matrix::Zero()};  ///< Phi
  double white = 0.0;
};

inline constexpr int kMostStates = 12;
inline constexpr int kMostParameters = 20;

/// Calls `pass` with the smallest size that has room for `states`.
template <class Pass>
decltype(auto) with_size(Eigen::Index states, const Pass& pass) {
  if (states <= 2) return pass(std::integral_constant<int, 2>{});
  if (states <= 3) return pass(std::integral_constant<int, 3>{});
  if (states <= 4) return pass(std::integral_constant<int, 4>{});
  if (states <= 6) return pass(std::integral_constant<int, 6>{});
  if (states <= kMostStates) return pass(std::integral_constant<int, kMostStates>{});
  throw std::invalid_argument("a sum of processes with more than 12 states");
}

/// Detects when a covariance recursion is stationary: steps whose innovation variance no longer changes share their gain.
template <int N>
class SteadyState {
 public:
  using Matrix = typename FixedModel<N>::Matrix;
  static constexpr int kStride = 64;  ///< steps between checks

  /// Relative change since the last check, each element relative to the diagonal; two of them give the remaining change.
  [[nodiscard]] bool reached(const Matrix& P) {
    double change = 0.0;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) {
        const double scale = P(i, i) * P(j, j);
        if (scale > 0.0) change = std::max(change, std::abs(P(i, j) - last_(i, j)) / std::sqrt(scale));
      }
    const double rate = change_ > 0.0 ? change / change_ : 1.0;
    last_ = P;
    change_ = change;
    return change < kRounding || (rate < 1.0 && change < kSmall && change * rate / (1.0 - rate) < kLeft);
  }

 private:
  static constexpr double kRounding = 4e-15;
  static constexpr double kSmall = 1e-11;
  static constexpr double kLeft = 1e-13;
  Matrix last_ = Matrix::Zero();
  double change_ = 0.0;
};

}  // namespace coast::noise
