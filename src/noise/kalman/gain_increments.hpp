#pragma once
// The covariance recursion of the filter and its derivatives by increments of low rank. Private to the room.

#include <vector>

#include "fixed_model.hpp"

namespace coast::noise {

/// Chandrasekhar's recursion (Morf, Sidhu & Kailath 1974). From a start that is stationary except in one state,
///
///     P[k+1] - P[k] = L[k] M[k] L[k]',   L of two columns,
///
/// for all k: the gain needs products of N x 2 where the Riccati recursion needs N x N. With Y = h L, w = M Y':
///
///     P h' <- P h' + L w,   S <- S + Y w,   L <- Phi (L - k Y) with the new k = P h'/S,   M <- M + w w'/S with the old S
template <int N>
class GainIncrements {
 public:
  using Model = FixedModel<N>;
  using Vector = typename Model::Vector;
  using Slopes = Eigen::Matrix<double, N, Eigen::Dynamic, 0, N, kMostParameters>;

  /// Whether the start is of this kind.
  [[nodiscard]] static bool apply_to(const Model& model) {
    int moving = 0;
    const Matrix change = first_change(model);
    for (int c = 0; c < N; ++c)
      for (int r = 0; r < N; ++r) {
        if (is_rounding(change(r, c), model.P_first(r, r), model.P_first(c, c))) continue;
        if (r != c) return false;
        ++moving;
      }
    return moving <= 1;
  }

  /// @param model, slopes  must outlive this
  GainIncrements(const Model& model, const std::vector<Model>& slopes)
      : model_(model), slopes_(slopes), count_(static_cast<Eigen::Index>(slopes.size())), rest_(slopes.size() + 1) {
    PHt_ = model.P_first * model.h.transpose();
    S = model.h.dot(PHt_) + model.white;
    k = PHt_ / S;
    dPHt_.setZero(N, count_);
    dk.setZero(N, count_);
    dS.setZero(count_);
    for (Eigen::Index i = 0; i < count_; ++i) {
      const Model& slope = slopes_[at(i)];
      dPHt_.col(i) = slope.P_first * model.h.transpose();
      dS(i) = model.h.dot(dPHt_.col(i)) + slope.white;
      dk.col(i) = (dPHt_.col(i) - k * dS(i)) / S;
    }
    start_increments();
  }

  void step() {
    if (steady_) return;
    const Pair Y = (model_.h * L_).transpose();
    const Pair w = M_ * Y;
    const double S_before = S;
    const Vector v = L_ * w;
    PHt_ += v;
    S += model_.h.dot(v);
    k = PHt_ / S;
    const Columns left = L_ - k * Y.transpose();
    for (Eigen::Index i = 0; i < count_; ++i) step_slope(i, Y, w, S_before, left);
    L_ = model_.sparse.left(left);
    M_ += w * w.transpose() / S_before;
    if (++since_look_ == SteadyState<N>::kStride) look();
  }
  [[nodiscard]] bool steady() const { return steady_; }

  double S = 0.0;  ///< variance of the innovation
  Vector k;        ///< P h'/S
  Slopes dk;       ///< one column per parameter
  Eigen::VectorXd dS;

 private:
  using Matrix = typename Model::Matrix;
  using Columns = Eigen::Matrix<double, N, 2>;
  using Pair = Eigen::Vector2d;
  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

  /// Change of P in the first step without a measurement; zero for a stationary start.
  static Matrix first_change(const Model& model) { return model.sparse.congruence(model.P_first) + model.Q - model.P_first; }
  static bool is_rounding(double change, double P_r, double P_c) {
    constexpr double kRounding = 1e-10;  // error of the stationary start's solution
    return std::abs(change) <= kRounding * std::sqrt(P_r * P_c);
  }

  void start_increments() {
    L_.setZero();
    M_.setZero();
    L_.col(0) = model_.sparse.left(k);
    M_(0, 0) = -S;
    const Matrix change = first_change(model_);
    int moving = -1;
    for (int i = 0; i < N; ++i)
      if (!is_rounding(change(i, i), model_.P_first(i, i), model_.P_first(i, i))) moving = i;
    if (moving >= 0) {
      L_(moving, 1) = 1.0;
      M_(1, 1) = change(moving, moving);
    }
    for (Eigen::Index i = 0; i < count_; ++i) {
      const Model& slope = slopes_[at(i)];
      dL_.push_back(Columns::Zero());
      dM_.push_back(Eigen::Matrix2d::Zero());
      dL_.back().col(0) = model_.sparse.left(Vector(dk.col(i))) + slope.sparse.left(k);
      dM_.back()(0, 0) = -dS(i);
      if (moving < 0) continue;
      const Matrix turned = slope.Phi * model_.P_first * model_.Phi.transpose();
      const Matrix d = model_.sparse.congruence(slope.P_first) + turned + turned.transpose() + slope.Q - slope.P_first;
      dM_.back()(1, 1) = d(moving, moving);
    }
  }

  void step_slope(Eigen::Index i, const Pair& Y, const Pair& w, double S_before, const Columns& left) {
    Columns& dL = dL_[at(i)];
    Eigen::Matrix2d& dM = dM_[at(i)];
    const Pair dY = (model_.h * dL).transpose();
    const Pair dw = dM * Y + M_ * dY;
    const Vector dv = dL * w + L_ * dw;
    const double dS_before = dS(i);
    dPHt_.col(i) += dv;
    dS(i) += model_.h.dot(dv);
    dk.col(i) = (dPHt_.col(i) - k * dS(i)) / S;
    dL = model_.sparse.left(Columns(dL - dk.col(i) * Y.transpose() - k * dY.transpose()));
    if (!slopes_[at(i)].sparse.empty()) dL += slopes_[at(i)].sparse.left(left);
    dM += (dw * w.transpose() + w * dw.transpose()) / S_before - w * w.transpose() * (dS_before / (S_before * S_before));
  }

  /// P is not kept; its change is approximated as if every step since the last check had been like this one.
  void look() {
    since_look_ = 0;
    const auto stride = static_cast<double>(SteadyState<N>::kStride);
    if (P_.empty()) {
      P_.push_back(model_.P_first);
      for (const Model& slope : slopes_) P_.push_back(slope.P_first);
    }
    P_[0] += stride * L_ * M_ * L_.transpose();
    bool all = rest_[0].reached(P_[0]);
    for (Eigen::Index i = 0; i < count_; ++i) {
      const Columns& dL = dL_[at(i)];
      const Matrix cross = dL * M_ * L_.transpose();
      P_[at(i) + 1] += stride * (cross + cross.transpose() + L_ * dM_[at(i)] * L_.transpose());
      all = rest_[at(i) + 1].reached(P_[0] + P_[at(i) + 1]) && all;
    }
    steady_ = all;
  }

  const Model& model_;
  const std::vector<Model>& slopes_;
  Eigen::Index count_;
  Vector PHt_;
  Columns L_;
  Eigen::Matrix2d M_;
  Slopes dPHt_;
  std::vector<Columns> dL_;
  std::vector<Eigen::Matrix2d> dM_;
  std::vector<Matrix> P_;  ///< approximate P, for scale; its derivatives
  std::vector<SteadyState<N>> rest_;
  int since_look_ = 0;
  bool steady_ = false;
};

}  // namespace coast::noise
