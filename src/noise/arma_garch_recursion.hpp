#pragma once
// The recursions of an ARMA-GARCH likelihood, forwards, backwards, and with their sensitivities. Private to the room.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "coast/noise/arma_garch.hpp"

namespace coast::noise {

/// Positions in a centred parameter vector [mu, alpha, beta, gamma0, gamma, delta]: mu is the mean of y, whose estimate is
/// almost independent of alpha, unlike nu = mu (1 - sum alpha).
struct ArmaGarchLayout {
  explicit ArmaGarchLayout(const ArmaGarchOrders& orders)
      : ar(orders.ar), ma(orders.ma), arch(orders.arch), garch(orders.garch) {}
  Eigen::Index ar;
  Eigen::Index ma;
  Eigen::Index arch;
  Eigen::Index garch;
  [[nodiscard]] Eigen::Index alpha() const { return 1; }
  [[nodiscard]] Eigen::Index beta() const { return 1 + ar; }
  [[nodiscard]] Eigen::Index gamma0() const { return 1 + ar + ma; }  ///< also the number of parameters that act on residuals
  [[nodiscard]] Eigen::Index gamma() const { return gamma0() + 1; }
  [[nodiscard]] Eigen::Index delta() const { return gamma() + arch; }
  [[nodiscard]] Eigen::Index size() const { return delta() + garch; }
};

[[nodiscard]] Eigen::VectorXd centred_vector(const ArmaGarch& model);
[[nodiscard]] ArmaGarch model_of_centred(const ArmaGarchLayout& layout, const Eigen::VectorXd& centred);
/// d natural/d centred; the first row and column (nu by mu) are present even if nu is fixed.
[[nodiscard]] Eigen::MatrixXd natural_by_centred(const ArmaGarchLayout& layout, const Eigen::VectorXd& centred);

/// Log-likelihood of one series, O(n (d + h + p + q)) with its gradient. Buffers are kept between calls.
class ArmaGarchRecursion {
 public:
  ArmaGarchRecursion(const ArmaGarchOrders& orders, const ArmaGarchSeries& series, ArmaGarchStart start);

  [[nodiscard]] double value(const Eigen::VectorXd& centred);
  /// By the adjoint recursions: first the variance's backwards, then the mean's.
  double slope(const Eigen::VectorXd& centred, Eigen::VectorXd& gradient);

  /// Sensitivities of every sample, by forward recursion.
  struct Information {
    double value = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd expected;  ///< sum of de de'/s2 + ds2 ds2'/(2 s2^2): Fisher's for normal e, given the series
  };
  [[nodiscard]] Information information(const Eigen::VectorXd& centred);
  [[nodiscard]] Eigen::MatrixXd scores(const Eigen::VectorXd& centred);  ///< row t, column parameter

  [[nodiscard]] const ArmaGarchLayout& layout() const { return layout_; }
  [[nodiscard]] std::size_t observations() const { return observations_; }
  /// From the last call.
  [[nodiscard]] std::span<const double> residuals() const { return after_lags(residual_); }
  [[nodiscard]] std::span<const double> variances() const { return after_lags(variance_); }

 private:
  [[nodiscard]] std::span<const double> after_lags(const std::vector<double>& buffer) const {
    return {buffer.data() + lags_, static_cast<std::size_t>(n_)};
  }
  void run_mean(const Eigen::VectorXd& centred);
  void run_variance(const Eigen::VectorXd& centred);
  double run_variance_back(const Eigen::VectorXd& centred, Eigen::VectorXd& gradient);
  void run_mean_back(const Eigen::VectorXd& centred, double by_mean_square, Eigen::VectorXd& gradient);
  void run_mean_sensitivity(const Eigen::VectorXd& centred);
  void run_variance_sensitivity(const Eigen::VectorXd& centred);

  ArmaGarchLayout layout_;
  Eigen::Index n_;
  Eigen::Index lags_;             ///< samples of padding before (and, for adjoints, after) the series
  Eigen::Index held_residuals_;   ///< number of first residuals that are 0 for all parameters
  Eigen::Index held_variances_;   ///< number of first variances that are gamma0 + persistence times the mean square
  std::size_t observations_ = 0;  ///< number of samples that count
  Eigen::VectorXd y_;
  std::vector<std::uint8_t> is_missing_;
  Eigen::ArrayXd counted_;  ///< 1; 0 if missing, or while the effect of a gap has not decayed
  double mean_square_ = 0.0;
  // Padded by lags_ at the front:
  std::vector<double> x_;         ///< y - mu, or its prediction
  std::vector<double> residual_;  ///< e
  std::vector<double> square_;    ///< e^2, or its expectation
  std::vector<double> variance_;  ///< s2
  // Adjoints, padded by lags_ at the end:
  std::vector<double> variance_bar_;
  std::vector<double> row_bar_;  ///< of the equation of each sample's mean
  std::vector<double> residual_bar_;
  // Sensitivities, one column per sample, padded at the front:
  Eigen::MatrixXd x_by_;
  Eigen::MatrixXd residual_by_;
  Eigen::MatrixXd square_by_;
  Eigen::MatrixXd variance_by_;
};

}  // namespace coast::noise
