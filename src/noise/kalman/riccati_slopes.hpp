#pragma once
// The covariance recursion of the filter and its derivatives by the Riccati recursion. Private to the room.

#include <vector>

#include "gain.hpp"

namespace coast::noise {

/// dS = h dP h' + dr,  dk = (dP h' - k dS)/S,  dP' = Phi dP_upd Phi' + dPhi P_upd Phi' + Phi P_upd dPhi' + dQ
template <int N>
class RiccatiSlopes {
 public:
  using Model = FixedModel<N>;
  using Matrix = typename Model::Matrix;
  using Slopes = Eigen::Matrix<double, N, Eigen::Dynamic, 0, N, kMostParameters>;

  /// @param model, slopes  must outlive this
  RiccatiSlopes(const Model& model, const std::vector<Model>& slopes)
      : gain(model), model_(model), slopes_(slopes), count_(static_cast<Eigen::Index>(slopes.size())), rest_(slopes.size()) {
    for (const Model& slope : slopes) dP_.push_back(slope.P_first);
    dk.setZero(N, count_);
    dS.setZero(count_);
    measure();
  }

  [[nodiscard]] bool steady() const { return steady_; }

  void skip() {
    const Matrix right = model_.sparse.right(gain.P);
    for (Eigen::Index i = 0; i < count_; ++i) predict(i, right, Matrix(dP_[at(i)]));
    gain.skip();
    measure();
    steady_ = false;
  }
  void step() {
    const double S = gain.S;
    const Matrix right = model_.sparse.right(gain.P - S * gain.k * gain.k.transpose());
    for (Eigen::Index i = 0; i < count_; ++i) {
      // d(S k k') = w k' + k w'
      const typename Model::Vector w = 0.5 * dS(i) * gain.k + S * dk.col(i);
      Matrix updated;
      for (int c = 0; c < N; ++c) updated.col(c) = dP_[at(i)].col(c) - gain.k(c) * w - w(c) * gain.k;
      predict(i, right, updated);
    }
    gain.step();
    measure();
    look();
  }

  Gain<N> gain;
  Slopes dk;  ///< one column per parameter
  Eigen::VectorXd dS;

 private:
  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

  void measure() {
    for (Eigen::Index i = 0; i < count_; ++i) {
      const typename Model::Vector dPHt = dP_[at(i)] * model_.h.transpose();
      dS(i) = model_.h.dot(dPHt) + slopes_[at(i)].white;
      dk.col(i) = (dPHt - gain.k * dS(i)) / gain.S;
    }
  }
  /// @param right  P_upd Phi'
  void predict(Eigen::Index i, const Matrix& right, const Matrix& dP_upd) {
    const Model& slope = slopes_[at(i)];
    Matrix next = model_.sparse.congruence(dP_upd);
    // dPhi P_upd Phi' = ((P_upd Phi')' dPhi')'
    if (!slope.sparse.empty()) next += 2.0 * slope.sparse.right(right.transpose());
    dP_[at(i)] = 0.5 * (next + next.transpose()) + slope.Q;
  }
  /// Filter and derivatives become stationary together.
  void look() {
    if (++since_look_ < SteadyState<N>::kStride) return;
    since_look_ = 0;
    bool all = gain.steady();
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      // Relative to P itself: the derivatives are with respect to logarithms.
      all = rest_[i].reached(gain.P + dP_[i]) && all;
    }
    steady_ = all;
  }

  const Model& model_;
  const std::vector<Model>& slopes_;
  Eigen::Index count_;
  std::vector<Matrix> dP_;
  std::vector<SteadyState<N>> rest_;
  int since_look_ = 0;
  bool steady_ = false;
};

}  // namespace coast::noise
