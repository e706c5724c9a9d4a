#pragma once
// An autoregressive series as a linear system at its own rate, sums of it, and the equivalent continuous process.

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

namespace coast::noise {

/// x[k] = a[0] x[k-1] + ... + a[p-1] x[k-p] + e[k], var e = innovation_variance; state (x[k], ..., x[k-p+1]).
///
/// Poles near 1 differ from 1 only in their last digits, which powers of A lose: internally long double is used.
class Autoregression {
 public:
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using Column = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  using Row = Eigen::Matrix<long double, 1, Eigen::Dynamic>;

  Autoregression(const Eigen::VectorXd& coefficients, double innovation_variance);

  [[nodiscard]] Eigen::Index order() const { return A_.rows(); }
  /// For one step; eigenvalues of the companion matrix.
  [[nodiscard]] static Eigen::VectorXcd poles(const Eigen::VectorXd& coefficients);
  /// Largest modulus of a pole; the series is stationary, and has a covariance, only if it is below 1.
  [[nodiscard]] static double largest_pole(const Eigen::VectorXd& coefficients);
  /// P = A P A' + b b' innovation_variance: the covariance of the state at any time.
  [[nodiscard]] const Matrix& covariance() const { return P_; }

  /// Effect of m steps: state' = Phi state + e, sum of the m values held = T state + n, with var e, cov(e, n) and var n.
  struct Steps {
    Matrix Phi;
    Row T;
    Matrix var_e;
    Column cov_en;
    long double var_n = 0.0L;
  };
  /// By doubling, in log2(m) products. @param m >= 0
  [[nodiscard]] Steps steps(std::uint64_t m) const;
  /// Allan and Hadamard variance of means over m values. No large numbers are subtracted, so there is no loss of digits for
  /// poles near 1 or for any m. @param m >= 1
  [[nodiscard]] double allan_variance(std::uint64_t m) const;
  [[nodiscard]] double hadamard_variance(std::uint64_t m) const;

 private:
  Matrix A_;
  Matrix P_;
  std::vector<Steps> powers_;  ///< of one step, two, four, ...
};

/// A stationary process in continuous time whose autocovariance at integer lags is that of a series, in modal form:
///
///     dz = mu z ds + g dW,    x = sum z,    R(s) = sum c exp(mu s)
///
/// Time s is counted in samples. States are z of real modes, real and imaginary part of z of each conjugate pair.
///
/// With the poles lambda of the series, mu = log(lambda), and c are those of the series. R is an autocovariance also at other
/// lags if its spectrum, sum -2 mu c/(mu^2 + omega^2), is nowhere negative; g is from its spectral factorisation.
class ContinuousForm {
 public:
  /// None if there is no such real process: poles that are zero or negative, a spectrum that is negative somewhere, as for fast
  /// oscillations; or if poles are so close together that rounding spoils the autocovariance.
  [[nodiscard]] static std::optional<ContinuousForm> of(const Eigen::VectorXd& coefficients, double innovation_variance);

  void transition(double s, Eigen::Ref<Eigen::MatrixXd> Phi) const;
  void driving_noise(double s, Eigen::Ref<Eigen::MatrixXd> Q_d) const;
  void output(Eigen::Ref<Eigen::RowVectorXd> h) const;
  void covariance(Eigen::Ref<Eigen::MatrixXd> P) const;

 private:
  ContinuousForm(const Eigen::VectorXcd& mu, const Eigen::VectorXcd& g);
  template <typename Factor>
  [[nodiscard]] Eigen::MatrixXd of_states(Factor factor) const;  ///< g_i g_j factor(mu_i + mu_j), in real states
  [[nodiscard]] bool agrees_with(const Autoregression& series) const;
  Eigen::VectorXcd mu_;  ///< real modes have an imaginary part of exactly zero; of a conjugate pair the upper one comes first
  Eigen::VectorXcd g_;
  Eigen::MatrixXcd to_real_;
};

}  // namespace coast::noise
