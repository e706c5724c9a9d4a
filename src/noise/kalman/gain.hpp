#pragma once
// The covariance recursion of the filter, step by step until it is stationary. Private to the room.

#include "fixed_model.hpp"

namespace coast::noise {

template <int N>
class Gain {
 public:
  using Model = FixedModel<N>;
  explicit Gain(const Model& model) : P(model.P_first), model_(model) { measure(); }

  /// Prediction across one missing sample.
  void skip() {
    predict(P);
    measure();
    steady_ = false;
    since_look_ = 0;
  }
  /// Update with a sample and prediction to the next one.
  void step() {
    if (steady_) return;
    predict(P - S * k * k.transpose());
    measure();
    if (++since_look_ < SteadyState<N>::kStride) return;
    since_look_ = 0;
    steady_ = rest_.reached(P);
  }
  [[nodiscard]] bool steady() const { return steady_; }
  [[nodiscard]] bool positive() const { return S > 0.0 && std::isfinite(S); }

  typename Model::Matrix P;  ///< predicted
  double S = 0.0;            ///< variance of the innovation
  typename Model::Vector k;  ///< P h'/S

 private:
  void predict(const typename Model::Matrix& updated) {
    const typename Model::Matrix moved = model_.sparse.congruence(updated);
    P = 0.5 * (moved + moved.transpose()) + model_.Q;
  }
  void measure() {
    k.noalias() = P * model_.h.transpose();
    S = model_.h.dot(k) + model_.white;
    k /= S;
  }

  const Model& model_;
  SteadyState<N> rest_;
  int since_look_ = 0;
  bool steady_ = false;
};

}  // namespace coast::noise
