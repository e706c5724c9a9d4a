#pragma once
// An autoregressive series as a linear system at its own rate, sums of it, and the continuous process behind it.

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <optional>

namespace coast::noise {

/// x[k] = a[0] x[k-1] + ... + a[p-1] x[k-p] + e[k], var e = innovation_variance; state (x[k], ..., x[k-p+1]).
///
/// Poles near 1 are told from 1 by their last digits, which powers use up: inside there are long doubles.
class Autoregression {
 public:
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using Column = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  using Row = Eigen::Matrix<long double, 1, Eigen::Dynamic>;

  Autoregression(const Eigen::VectorXd& coefficients, double innovation_variance);

  [[nodiscard]] Eigen::Index order() const { return A_.rows(); }
  /// Of one step; of the companion matrix.
  [[nodiscard]] static Eigen::VectorXcd poles(const Eigen::VectorXd& coefficients);
  /// Largest modulus of a pole; the series is stationary if it is below 1, and only then is there a covariance.
  [[nodiscard]] static double largest_pole(const Eigen::VectorXd& coefficients);
  /// P = A P A' + b b' innovation_variance: the covariance of the state at any time.
  [[nodiscard]] const Matrix& covariance() const { return P_; }

  /// What m steps do: state' = Phi state + e, sum of the m values held = T state + n, with var e, cov(e, n) and var n.
  struct Steps {
    Matrix Phi;
    Row T;
    Matrix var_e;
    Column cov_en;
    long double var_n = 0.0L;
  };
  /// By doubling, in log2(m) products. @param m >= 0
  [[nodiscard]] Steps steps(std::uint64_t m) const;
  /// Allan and Hadamard variance of means over m values. No difference of large numbers is taken, so they keep their digits for
  /// poles near 1 and for any m. @param m >= 1
  [[nodiscard]] double allan_variance(std::uint64_t m) const;
  [[nodiscard]] double hadamard_variance(std::uint64_t m) const;

 private:
  Matrix A_;
  Matrix P_;
  double innovation_variance_;
};

/// A stationary process in continuous time whose autocovariance at whole lags is that of a series, in its own modes:
///
///     dz = mu z ds + g dW,    x = sum z,    R(s) = sum c exp(mu s)
///
/// Time s is counted in samples. States are z of real modes, real and imaginary part of z of each conjugate pair.
///
/// With the poles lambda of the series mu = log(lambda), and c are the series' own. That R is an autocovariance between whole
/// lags too wants a spectrum, sum -2 mu c/(mu^2 + omega^2), that is nowhere negative; g is its factor (spectral factorisation).
class ContinuousForm {
 public:
  /// Nothing where there is no such real process: poles that are zero or negative, a spectrum that is negative somewhere, as
  /// for fast oscillations; or where poles so close together that rounding spoils the autocovariance.
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
  Eigen::VectorXcd mu_;  ///< real modes have an imaginary part of exactly zero; of a pair the upper one stands first
  Eigen::VectorXcd g_;
  Eigen::MatrixXcd to_real_;
};

}  // namespace coast::noise
