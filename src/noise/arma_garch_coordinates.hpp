#pragma once
// Unbounded parameters of an ARMA-GARCH model. Private to the room.

#include <Eigen/Core>
#include <vector>

#include "arma_garch_recursion.hpp"

namespace coast::noise {

/// Coefficients from partial autocorrelations, stationary for any inside (-1, 1), and their derivatives: Monahan (1984), by
/// Levinson & Durbin's recursion.
struct ArCoefficients {
  Eigen::VectorXd a;
  Eigen::MatrixXd slope;  ///< d a/d partial
};
[[nodiscard]] ArCoefficients ar_from_partial(const Eigen::VectorXd& partial);

/// u = [mu, atanh of partial autocorrelations of alpha, of -beta, log s2, logit of the persistence, log of the shares of gamma
/// and delta in it relative to the last one], s2 the variance of e: for a series about its mean, in units of its deviation.
class ArmaGarchCoordinates {
 public:
  ArmaGarchCoordinates(const ArmaGarchOrders& orders, bool constant) : layout_(orders), constant_(constant) {}

  [[nodiscard]] const ArmaGarchLayout& layout() const { return layout_; }
  [[nodiscard]] Eigen::VectorXd centred(const Eigen::VectorXd& u) const;
  [[nodiscard]] Eigen::MatrixXd centred_by_u(const Eigen::VectorXd& u) const;
  /// The inverse, from any point: coefficients that are not stationary or not invertible are damped until they are.
  [[nodiscard]] Eigen::VectorXd inside(const Eigen::VectorXd& centred) const;
  [[nodiscard]] std::vector<Interval> box() const;

 private:
  [[nodiscard]] Eigen::Index moving() const { return layout_.arch + layout_.garch; }
  [[nodiscard]] Eigen::VectorXd shares(const Eigen::VectorXd& u) const;
  ArmaGarchLayout layout_;
  bool constant_;
};

}  // namespace coast::noise
