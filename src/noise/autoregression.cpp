#include "autoregression.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace coast::noise {

namespace {

using Complex = std::complex<double>;
using Matrix = Autoregression::Matrix;
using Row = Autoregression::Row;
using LongComplex = std::complex<long double>;

Eigen::MatrixXd companion_of(const Eigen::VectorXd& coefficients) {
  const Eigen::Index p = coefficients.size();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(p, p);
  A.row(0) = coefficients;
  A.diagonal(-1).setOnes();
  return A;
}

// `first` followed by `second`.
Autoregression::Steps then(const Autoregression::Steps& first, const Autoregression::Steps& second) {
  Autoregression::Steps both;
  both.Phi = second.Phi * first.Phi;
  both.T = first.T + second.T * first.Phi;
  both.var_e = second.Phi * first.var_e * second.Phi.transpose() + second.var_e;
  both.cov_en = second.Phi * (first.cov_en + first.var_e * second.T.transpose()) + second.cov_en;
  both.var_n = first.var_n + 2.0L * second.T.dot(first.cov_en) + second.T * first.var_e * second.T.transpose() + second.var_n;
  return both;
}

Autoregression::Steps nothing(Eigen::Index p) {
  return {Matrix::Identity(p, p), Row::Zero(p), Matrix::Zero(p, p), Autoregression::Column::Zero(p), 0.0L};
}

long double form(const Row& a, const Matrix& M) {
  return (a * M * a.transpose())(0, 0);
}

}  // namespace

Eigen::VectorXcd Autoregression::poles(const Eigen::VectorXd& coefficients) {
  return companion_of(coefficients).eigenvalues();
}

double Autoregression::largest_pole(const Eigen::VectorXd& coefficients) {
  return poles(coefficients).cwiseAbs().maxCoeff();
}

Autoregression::Autoregression(const Eigen::VectorXd& coefficients, double innovation_variance)
    : A_(companion_of(coefficients).cast<long double>()) {
  // P = sum A^k b b' A'^k, doubled until the rest has decayed.
  const Eigen::Index p = A_.rows();
  P_ = Matrix::Zero(p, p);
  P_(0, 0) = innovation_variance;
  Matrix power = A_;
  for (int k = 0; k < 64 && power.norm() > 1e-20L; ++k) {
    P_ += (power * P_ * power.transpose()).eval();
    power = (power * power).eval();
  }
  P_ = (0.5L * (P_ + P_.transpose())).eval();
  constexpr std::size_t kPowers = 16;  // a curve asks for the effect of many numbers of steps
  Steps once = nothing(p);
  once.Phi = A_;
  once.T(0) = 1.0L;  // a value is summed before the step
  once.var_e(0, 0) = innovation_variance;
  powers_.push_back(once);
  while (powers_.size() < kPowers) powers_.push_back(then(powers_.back(), powers_.back()));
}

Autoregression::Steps Autoregression::steps(std::uint64_t m) const {
  Steps result = nothing(order());
  for (const Steps& power : powers_) {
    if (m & 1U) result = then(result, power);
    m >>= 1U;
  }
  if (m == 0) return result;
  Steps power = then(powers_.back(), powers_.back());
  for (; m > 0; m >>= 1U) {
    if (m & 1U) result = then(result, power);
    if (m > 1) power = then(power, power);
  }
  return result;
}

// Second sum minus first, as function of the state before both and of the innovations during each.
double Autoregression::allan_variance(std::uint64_t m) const {
  const Steps s = steps(m);
  const Matrix change = s.Phi - Matrix::Identity(order(), order());
  const long double first = form(s.T, s.var_e) - 2.0L * s.T.dot(s.cov_en) + s.var_n;
  const long double sum = form(s.T * change, P_) + first + s.var_n;
  return static_cast<double>(sum / (2.0L * static_cast<long double>(m) * static_cast<long double>(m)));
}

double Autoregression::hadamard_variance(std::uint64_t m) const {
  const Steps s = steps(m);
  const Matrix change = s.Phi - Matrix::Identity(order(), order());
  const Row after_first = s.T * (change - Matrix::Identity(order(), order()));
  const long double first = form(after_first, s.var_e) + 2.0L * after_first.dot(s.cov_en) + s.var_n;
  const long double second = form(s.T, s.var_e) - 4.0L * s.T.dot(s.cov_en) + 4.0L * s.var_n;
  const long double sum = form(s.T * change * change, P_) + first + second + s.var_n;
  return static_cast<double>(sum / (6.0L * static_cast<long double>(m) * static_cast<long double>(m)));
}

namespace {

// Zeros of z^p - a[0] z^(p-1) - ... - a[p-1], refined by Newton; real ones exactly real, of a pair only the upper one.
std::vector<LongComplex> poles_of(const Eigen::VectorXd& coefficients) {
  std::vector<LongComplex> poles;
  for (const Complex& start : companion_of(coefficients).eigenvalues()) {
    if (start.imag() < 0.0) continue;
    LongComplex z(start.real(), start.imag());
    for (int newton = 0; newton < 4; ++newton) {
      LongComplex value(1.0L), slope(0.0L);
      for (const double a : coefficients) {
        slope = slope * z + value;
        value = value * z - static_cast<long double>(a);
      }
      if (slope != LongComplex(0.0L)) z -= value / slope;
    }
    poles.push_back(z);
  }
  std::vector<LongComplex> all;
  for (const LongComplex& z : poles) {
    all.push_back(z);
    if (z.imag() != 0.0L) all.push_back(std::conj(z));
  }
  return all;
}

// c of R(n) = sum c lambda^n.
std::vector<LongComplex> shares_of(const std::vector<LongComplex>& poles, double innovation_variance) {
  std::vector<LongComplex> shares;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    LongComplex c(innovation_variance);
    for (std::size_t j = 0; j < poles.size(); ++j) {
      if (j != i) c *= poles[i] / (poles[i] - poles[j]);
      c /= LongComplex(1.0L) - poles[i] * poles[j];
    }
    shares.push_back(c);
  }
  return shares;
}

// The zeros in the left half-plane of the spectrum's numerator, sum_i -2 mu_i c_i prod_{j != i} (mu_j^2 - q), q = (i omega)^2;
// none if it is negative for some omega.
std::optional<std::vector<Complex>> spectral_zeros(const std::vector<LongComplex>& mu, const std::vector<LongComplex>& c) {
  const std::size_t p = mu.size();
  std::vector<LongComplex> numerator(p, 0.0L);
  for (std::size_t i = 0; i < p; ++i) {
    std::vector<LongComplex> product{-2.0L * mu[i] * c[i]};
    for (std::size_t j = 0; j < p; ++j) {
      if (j == i) continue;
      product.push_back(0.0L);
      for (std::size_t k = product.size(); k-- > 0;)
        product[k] = mu[j] * mu[j] * product[k] - (k > 0 ? product[k - 1] : LongComplex(0.0L));
    }
    for (std::size_t k = 0; k < p; ++k) numerator[k] += product[k];
  }
  std::vector<Complex> zeros;
  const long double leading = numerator.back().real();
  if (p == 1) return zeros;
  Eigen::VectorXd monic(static_cast<Eigen::Index>(p) - 1);
  for (std::size_t k = 0; k + 1 < p; ++k)
    monic(static_cast<Eigen::Index>(p - 2 - k)) = static_cast<double>(-numerator[k].real() / leading);
  if (!monic.allFinite()) return std::nullopt;
  for (const Complex& q : companion_of(monic).eigenvalues()) {
    if (q.imag() == 0.0 && q.real() <= 0.0) return std::nullopt;
    zeros.push_back(-std::sqrt(q));
  }
  return zeros;
}

// exp(z) - 1 without loss of digits for a small z.
Complex expm1(const Complex& z) {
  const double half = std::sin(0.5 * z.imag());
  return {std::expm1(z.real()) * std::cos(z.imag()) - 2.0 * half * half, std::exp(z.real()) * std::sin(z.imag())};
}

Complex narrow(const LongComplex& z) {
  return {static_cast<double>(z.real()), static_cast<double>(z.imag())};
}

}  // namespace

ContinuousForm::ContinuousForm(const Eigen::VectorXcd& mu, const Eigen::VectorXcd& g)
    : mu_(mu), g_(g), to_real_(Eigen::MatrixXcd::Zero(mu.size(), mu.size())) {
  for (Eigen::Index i = 0; i < mu.size(); ++i) {
    if (mu(i).imag() == 0.0) {
      to_real_(i, i) = 1.0;
      continue;
    }
    to_real_.block(i, i, 2, 2) << Complex(0.5), Complex(0.5), Complex(0.0, -0.5), Complex(0.0, 0.5);
    ++i;
  }
}

std::optional<ContinuousForm> ContinuousForm::of(const Eigen::VectorXd& coefficients, double innovation_variance) {
  const std::vector<LongComplex> poles = poles_of(coefficients);
  const auto p = static_cast<Eigen::Index>(poles.size());
  if (p != coefficients.size()) return std::nullopt;
  std::vector<LongComplex> mu;
  for (const LongComplex& z : poles) {
    if (z.imag() == 0.0L && z.real() <= 0.0L) return std::nullopt;
    mu.push_back(std::log(z));
  }
  const std::vector<LongComplex> c = shares_of(poles, innovation_variance);
  const auto zeros = spectral_zeros(mu, c);
  LongComplex gain2(0.0L);  // -2 R'(0+), the height of the spectrum's tail
  for (std::size_t i = 0; i < mu.size(); ++i) gain2 += -2.0L * mu[i] * c[i];
  if (!zeros || !(gain2.real() > 0.0L)) return std::nullopt;
  Eigen::VectorXcd modes(p), g(p);
  for (Eigen::Index i = 0; i < p; ++i) {
    const auto at = static_cast<std::size_t>(i);
    LongComplex residue(std::sqrt(gain2.real()));
    for (const Complex& zero : *zeros) residue *= mu[at] - LongComplex(zero.real(), zero.imag());
    for (std::size_t j = 0; j < mu.size(); ++j)
      if (j != at) residue /= mu[at] - mu[j];
    modes(i) = narrow(mu[at]);
    g(i) = narrow(residue);
  }
  ContinuousForm result(modes, g);
  if (!g.allFinite() || !result.agrees_with({coefficients, innovation_variance})) return std::nullopt;
  return result;
}

// The factorisation is checked: its autocovariance is compared with that of the series.
bool ContinuousForm::agrees_with(const Autoregression& series) const {
  constexpr double kTolerance = 1e-9;  // of the variance
  const Eigen::Index p = series.order();
  Eigen::MatrixXd P(p, p), Phi = Eigen::MatrixXd::Zero(p, p);
  Eigen::RowVectorXd h(p);
  covariance(P);
  output(h);
  for (int lag = 0; lag <= 2 * p; ++lag) {
    transition(lag, Phi);
    const auto expected =
        static_cast<double>(series.steps(static_cast<std::uint64_t>(lag)).Phi.row(0).dot(series.covariance().col(0)));
    const double found = (h * Phi * P * h.transpose())(0, 0);
    if (!(std::abs(found - expected) <= kTolerance * static_cast<double>(series.covariance()(0, 0)))) return false;
  }
  return true;
}

void ContinuousForm::transition(double s, Eigen::Ref<Eigen::MatrixXd> Phi) const {
  Phi.setZero();
  for (Eigen::Index i = 0; i < mu_.size(); ++i) {
    const double decay = std::exp(mu_(i).real() * s), angle = mu_(i).imag() * s;
    if (mu_(i).imag() == 0.0) {
      Phi(i, i) = decay;
      continue;
    }
    Phi(i, i) = Phi(i + 1, i + 1) = decay * std::cos(angle);
    Phi(i + 1, i) = decay * std::sin(angle);
    Phi(i, i + 1) = -Phi(i + 1, i);
    ++i;
  }
}

template <typename Factor>
Eigen::MatrixXd ContinuousForm::of_states(Factor factor) const {
  const Eigen::Index p = mu_.size();
  Eigen::MatrixXcd of_modes(p, p);
  for (Eigen::Index i = 0; i < p; ++i)
    for (Eigen::Index j = 0; j < p; ++j) of_modes(i, j) = g_(i) * g_(j) * factor(mu_(i) + mu_(j));
  const Eigen::MatrixXd M = (to_real_ * of_modes * to_real_.transpose()).real();
  return 0.5 * (M + M.transpose());
}

void ContinuousForm::driving_noise(double s, Eigen::Ref<Eigen::MatrixXd> Q_d) const {
  Q_d = of_states([s](const Complex& sum) { return expm1(s * sum) / sum; });
}

void ContinuousForm::covariance(Eigen::Ref<Eigen::MatrixXd> P) const {
  P = of_states([](const Complex& sum) { return -1.0 / sum; });
}

void ContinuousForm::output(Eigen::Ref<Eigen::RowVectorXd> h) const {
  for (Eigen::Index i = 0; i < mu_.size(); ++i) {
    h(i) = 1.0;
    if (mu_(i).imag() == 0.0) continue;
    h(i) = 2.0;  // z and its conjugate
    h(++i) = 0.0;
  }
}

}  // namespace coast::noise
