#include "block_draws.hpp"

#include <algorithm>
#include <cmath>

namespace coast::noise {

namespace {

/// L with L L' = P, for a P that may be singular: a component without variance of its own has no column.
Eigen::MatrixXd lower_root(const Eigen::MatrixXd& P) {
  constexpr double kRounding = 1e-14;  // of the variance before the other components are removed
  const Eigen::Index n = P.rows();
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const double left = P(c, c) - L.row(c).head(c).squaredNorm();
    if (!(left > kRounding * P(c, c))) continue;
    L(c, c) = std::sqrt(left);
    for (Eigen::Index r = c + 1; r < n; ++r) L(r, c) = (P(r, c) - L.row(r).head(c).dot(L.row(c).head(c))) / L(c, c);
  }
  return L;
}

}  // namespace

BlockDraws::BlockDraws(const SampleBlock& block, std::uint64_t seed)
    : normal_(seed), sd_(std::sqrt(block.white)), states_(static_cast<std::size_t>(block.h.size())) {
  const Eigen::MatrixXd root = lower_root(block.Q);
  const Eigen::MatrixXd first = lower_root(block.P_first);
  for (std::size_t c = 0; c < states_; ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    h_[c] = block.h(column);
    std::ranges::copy(block.Phi.col(column), Phi_[c].begin());
    std::ranges::copy(root.col(column), step_[c].begin());
    if (!root.col(column).isZero(0.0)) sources_.push_back(c);
    const double fresh = normal_();
    for (std::size_t r = 0; r < states_; ++r) x_[r] += first(static_cast<Eigen::Index>(r), column) * fresh;
  }
}

template <std::size_t N>
double BlockDraws::next_of() {
  double y = sd_ > 0.0 ? sd_ * normal_() : 0.0;
  for (std::size_t i = 0; i < N; ++i) y += h_[i] * x_[i];
  std::array<double, N> after{};
  for (std::size_t c = 0; c < N; ++c)
    for (std::size_t r = 0; r < N; ++r) after[r] += Phi_[c][r] * x_[c];
  for (const std::size_t c : sources_) {
    const double fresh = normal_();
    for (std::size_t r = 0; r < N; ++r) after[r] += step_[c][r] * fresh;
  }
  std::ranges::copy(after, x_.begin());
  return y;
}

double BlockDraws::next() {
  if (states_ <= 2) return next_of<2>();
  if (states_ <= 4) return next_of<4>();
  if (states_ <= 6) return next_of<6>();
  if (states_ <= 8) return next_of<8>();
  return next_of<kMostStates>();
}

}  // namespace coast::noise
