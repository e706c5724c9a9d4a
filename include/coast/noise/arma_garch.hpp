#pragma once
// Series whose mean follows an ARMA and whose variance follows a GARCH recursion: model, likelihood, estimation, choice of
// orders.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "coast/noise/interval.hpp"

namespace coast::noise {

/// d, h, p, q of ARMA(d,h)-GARCH(p,q). garch > 0 needs arch > 0: without an ARCH term the variance is constant.
struct ArmaGarchOrders {
  int ar = 0;
  int ma = 0;
  int arch = 0;
  int garch = 0;
  bool operator==(const ArmaGarchOrders&) const = default;
};

/// Stebler et al. (2011), eqs. (8) and (9):
///
///     y[t] = nu + sum alpha_i y[t-i] + sum beta_i e[t-i] + e[t],    e[t] given the past: zero mean, variance s2[t]
///     s2[t] = gamma0 + sum gamma_i e[t-i]^2 + sum delta_i s2[t-i]
///
/// nu [signal], gamma0 [signal^2], the others [-]. Without gamma and delta the variance is gamma0 throughout.
struct ArmaGarch {
  double nu = 0.0;
  std::vector<double> alpha = {};
  std::vector<double> beta = {};
  double gamma0 = 1.0;
  std::vector<double> gamma = {};
  std::vector<double> delta = {};

  [[nodiscard]] ArmaGarchOrders orders() const;
  /// Empty if mean and variance exist: stationary, invertible, gamma0 > 0, gamma, delta >= 0, their sum below 1, numbers
  /// finite; otherwise states the defect.
  [[nodiscard]] std::string defect() const;
  [[nodiscard]] double mean() const;                    ///< of y, nu/(1 - sum alpha)
  [[nodiscard]] double persistence() const;             ///< sum of gamma and delta
  [[nodiscard]] double innovation_variance() const;     ///< of e, gamma0/(1 - persistence)
  [[nodiscard]] double unconditional_variance() const;  ///< of y: innovation_variance times the sum of psi^2
  /// The first `count` weights of y[t] - mean = sum psi[k] e[t-k], psi[0] = 1.
  [[nodiscard]] std::vector<double> psi_weights(std::size_t count) const;
  /// Least distance between a root of z^d - alpha_1 z^(d-1) - ... and one of z^h + beta_1 z^(h-1) + ...: if it is small the two
  /// factors nearly cancel, and both are poorly determined. Nothing without both.
  [[nodiscard]] std::optional<double> nearest_root_pair() const;
};

/// Names as in eq. (10): nu if `constant`, alpha1, ..., beta1, ..., gamma0, gamma1, ..., delta1, ...: the order of all vectors
/// and matrices of parameters here.
[[nodiscard]] std::vector<std::string> arma_garch_names(const ArmaGarchOrders& orders, bool constant);
[[nodiscard]] Eigen::VectorXd arma_garch_vector(const ArmaGarch& model, bool constant);
[[nodiscard]] ArmaGarch arma_garch_model(const ArmaGarchOrders& orders, bool constant, const Eigen::VectorXd& theta);

/// n samples with normal e, after a burn-in long enough for the start to have no effect.
/// @throws std::invalid_argument  the model has a defect
[[nodiscard]] std::vector<double> simulate_arma_garch(const ArmaGarch& model, std::size_t n, std::mt19937_64& generator);

/// After a gap the first residuals contain, besides e, the error of the prediction across it: so many samples have no factor in
/// the likelihood, and e^2 is replaced by its expectation. Exact for autoregressions up to this order; beta leaves a remainder,
/// as at any start. Without this, the estimate of delta from 20 000 samples with 40 gaps of 20 was 4.5 standard deviations off.
inline constexpr int kArmaGarchSettling = 5;

/// View of samples in time order. Missing values are not read: y is replaced by its prediction, e by 0, e^2 by its expectation
/// s2, and the likelihood has no factor there.
struct ArmaGarchSeries {
  std::span<const double> y;                      ///< [signal]
  std::span<const std::uint8_t> is_missing = {};  ///< empty: none missing
};

/// Values before the first sample. In both cases e^2 and s2 start at the mean of e^2 of the series.
enum class ArmaGarchStart {
  kConditional,  ///< y is its mean, e is 0, e^2 and s2 are the mean of e^2
  /// As fGarch 4022.89 with init.rec = "mci" (src/llhGarch.f): the first max(d,h) residuals are 0, the first max(p,q) variances
  /// are gamma0 + (sum gamma + sum delta) mean e^2; all samples count.
  kFgarch,
};

struct ArmaGarchOptions {
  bool constant = true;  ///< false: nu is 0
  ArmaGarchStart start = ArmaGarchStart::kConditional;
};

/// The functions below throw std::invalid_argument for a model with a defect, is_missing and y of different length, a value
/// that is not finite, and if fewer than 20 samples plus 5 per parameter count.
struct ArmaGarchResiduals {
  std::vector<double> residual;  ///< e[t] [signal]; 0 where missing
  std::vector<double> variance;  ///< s2[t] [signal^2]
};
[[nodiscard]] ArmaGarchResiduals arma_garch_residuals(const ArmaGarch& model, const ArmaGarchSeries& series,
                                                      ArmaGarchStart start = ArmaGarchStart::kConditional);

/// -1/2 sum (log 2 pi s2 + e^2/s2): the logarithm of L given below eq. (10), where the exponent is misprinted; e is y minus all
/// other terms.
[[nodiscard]] double arma_garch_log_likelihood(const ArmaGarch& model, const ArmaGarchSeries& series,
                                               ArmaGarchStart start = ArmaGarchStart::kConditional);
/// Exact gradient with respect to the parameters, by the backward (adjoint) recursion.
[[nodiscard]] Eigen::VectorXd arma_garch_gradient(const ArmaGarch& model, const ArmaGarchSeries& series,
                                                  const ArmaGarchOptions& options = {});
/// Gradient of every sample's term: row t, column parameter; rows of missing samples are 0.
[[nodiscard]] Eigen::MatrixXd arma_garch_scores(const ArmaGarch& model, const ArmaGarchSeries& series,
                                                const ArmaGarchOptions& options = {});

struct ArmaGarchFit {
  ArmaGarch model;
  ArmaGarchOptions options;
  double log_likelihood = 0.0;
  std::size_t observations = 0;  ///< samples that count: not missing, not within kArmaGarchSettling after a gap
  int parameters = 0;            ///< k
  bool converged = false;        ///< the quadratic model predicts a gain of less than 1e-10 of log-likelihood
  int evaluations = 0;           ///< of likelihood and gradient, over the whole series
  std::optional<double> nearest_root_pair;
  [[nodiscard]] double aic() const;   ///< 2 k - 2 log L; only indicative with a quasi-likelihood
  [[nodiscard]] double aicc() const;  ///< aic() + 2 k (k + 1)/(n - k - 1): Hurvich & Tsai (1995)
};
/// Quasi-maximum likelihood: as for normal e, which e need not be. Partial autocorrelations keep the model stationary and
/// invertible (Monahan 1984), a logistic split keeps the variance finite. Several starts, the first by Hannan & Rissanen
/// (1982), are optimised on the first 3000 samples by L-BFGS-B, the best two on all samples by Gauss-Newton steps.
[[nodiscard]] ArmaGarchFit fit_arma_garch(const ArmaGarchSeries& series, const ArmaGarchOrders& orders,
                                          const ArmaGarchOptions& options = {});

/// Covariance of the estimated parameters.
struct ArmaGarchUncertainty {
  Eigen::MatrixXd robust;     ///< A^-1 B A^-1, valid also if e is not normal: Bollerslev & Wooldridge (1992)
  Eigen::MatrixXd curvature;  ///< A^-1, valid for normal e
  [[nodiscard]] double robust_sd(Eigen::Index parameter) const;
};
/// A is minus the Hessian of the log-likelihood (central differences of the exact gradient), B the sum of outer products of
/// `arma_garch_scores`. Nothing if A is not positive definite: a parameter is at the edge of its range, or not identified.
[[nodiscard]] std::optional<ArmaGarchUncertainty> arma_garch_uncertainty(const ArmaGarchFit& fit,
                                                                         const ArmaGarchSeries& series);
/// 95 % interval of every parameter: estimate -+ 1.96 robust standard deviations.
[[nodiscard]] std::vector<Interval> arma_garch_intervals(const ArmaGarchFit& fit, const ArmaGarchUncertainty& uncertainty);

/// Estimates of one series with several orders.
struct ArmaGarchChoice {
  std::vector<ArmaGarchFit> fits;  ///< in the order of the argument
  std::size_t by_aic = 0;          ///< index of the smallest
  std::size_t by_aicc = 0;
};
/// d 0 to 3, h 0 to 2, (p,q) of (0,0), (1,0), (1,1), (2,1): 48.
[[nodiscard]] std::vector<ArmaGarchOrders> arma_garch_grid();
/// Runs in parallel; the result is bitwise the same for any number of threads.
/// @throws std::invalid_argument  no orders
[[nodiscard]] ArmaGarchChoice choose_arma_garch(const ArmaGarchSeries& series, const std::vector<ArmaGarchOrders>& orders,
                                                const ArmaGarchOptions& options = {});

}  // namespace coast::noise
