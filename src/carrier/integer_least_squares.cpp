#include "coast/carrier/integer_least_squares.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "coast/record/error.hpp"

namespace coast::carrier {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The nearest integer. Adding and subtracting 1.5 * 2^52 rounds in the adder: std::round is a call, made n^3 times.
double nearest(double x) {
  constexpr double kMagic = 6755399441055744.0;
  constexpr double kLargest = 2251799813685248.0;  // 2^51: beyond, x is an integer or has no fractional digits
  return std::abs(x) < kLargest ? (x + kMagic) - kMagic : x;
}

/// Q = L' D L of the decorrelated ambiguities Z' a, L unit lower triangular.
class Decorrelation {
 public:
  explicit Decorrelation(MatrixXd Q) : n_(Q.rows()), L_(MatrixXd::Zero(n_, n_)), D_(n_), Z_(MatrixXd::Identity(n_, n_)) {
    factorise(Q);
    reduce();
  }
  [[nodiscard]] const MatrixXd& L() const { return L_; }
  [[nodiscard]] const VectorXd& D() const { return D_; }
  [[nodiscard]] const MatrixXd& Z() const { return Z_; }

 private:
  /// From the last to the first, each time the ambiguity of smallest variance given those before: this leaves `reduce` few
  /// exchanges (Chang, Yang & Zhou 2005: symmetric pivoting).
  void factorise(MatrixXd& Q) {
    for (Index i = n_ - 1; i >= 0; --i) {
      Index best = i;
      Q.diagonal().head(i + 1).minCoeff(&best);
      if (best != i) {
        Q.row(best).head(i + 1).swap(Q.row(i).head(i + 1));
        Q.col(best).head(i + 1).swap(Q.col(i).head(i + 1));
        L_.col(best).tail(n_ - 1 - i).swap(L_.col(i).tail(n_ - 1 - i));
        Z_.col(best).swap(Z_.col(i));
      }
      D_(i) = Q(i, i);
      if (!(D_(i) > 0.0))
        throw NumericalError("ambiguity covariance", "", fmt::format("conditional variance {:.3g} of ambiguity {}", D_(i), i));
      L_.row(i).head(i + 1) = Q.row(i).head(i + 1) / D_(i);
      for (Index j = 0; j < i; ++j) Q.row(j).head(i) -= D_(i) * L_(i, j) * L_.row(i).head(i);
    }
  }
  /// Subtracts integer multiples of ambiguity i from ambiguity j, so that |L(i, j)| <= 1/2.
  void round_off(Index i, Index j) {
    const double mu = nearest(L_(i, j));
    if (mu == 0.0) return;
    L_.col(j).tail(n_ - i) -= mu * L_.col(i).tail(n_ - i);
    Z_.col(j) -= mu * Z_.col(i);
  }
  /// Exchanges j and j + 1; `variance` is that of j + 1 given all but j.
  void exchange(Index j, double variance) {
    const double eta = D_(j) / variance;
    const double lambda = D_(j + 1) * L_(j + 1, j) / variance;
    D_(j) = eta * D_(j + 1);
    D_(j + 1) = variance;
    for (Index k = 0; k < j; ++k) {
      const double upper = L_(j, k), lower = L_(j + 1, k);
      L_(j, k) = lower - L_(j + 1, j) * upper;
      L_(j + 1, k) = eta * upper + lambda * lower;
    }
    L_(j + 1, j) = lambda;
    for (Index k = j + 2; k < n_; ++k) std::swap(L_(k, j), L_(k, j + 1));
    Z_.col(j).swap(Z_.col(j + 1));
  }
  /// Until the conditional variances decrease no further: the last ambiguity, with which the search begins, has the smallest.
  void reduce() {
    constexpr double kGain = 1e-6;
    Index rounded = n_ - 2;
    for (Index j = n_ - 2; j >= 0;) {
      if (j <= rounded)
        for (Index i = j + 1; i < n_; ++i) round_off(i, j);
      const double variance = D_(j) + L_(j + 1, j) * L_(j + 1, j) * D_(j + 1);
      if (variance < (1.0 - kGain) * D_(j + 1)) {
        exchange(j, variance);
        rounded = j;
        j = n_ - 2;
      } else {
        --j;
      }
    }
  }

  Index n_;
  MatrixXd L_;
  VectorXd D_;
  MatrixXd Z_;
};

/// Depth-first over the integers, for each ambiguity the nearest first, within the largest norm allowed by the candidates.
class Search {
 public:
  Search(const Decorrelation& of, VectorXd z_float, int count)
      : Lt_(of.L().transpose()),
        D_(of.D()),
        float_(std::move(z_float)),
        z_(float_.size()),
        shifts_(MatrixXd::Zero(float_.size(), float_.size())),
        wanted_(static_cast<std::size_t>(count)) {}

  struct Candidate {
    VectorXd z;
    double norm;
  };
  [[nodiscard]] std::vector<Candidate> run() {
    descend(float_.size() - 1, 0.0);
    return found_;
  }

 private:
  static constexpr long kMostNodes = 20'000;  // beyond it the ambiguities cannot be fixed anyway

  [[nodiscard]] double bound() const {
    return found_.size() < wanted_ ? std::numeric_limits<double>::infinity() : found_.back().norm;
  }
  void descend(Index k, double norm) {
    const double centre = float_(k) + shifts_(k, k);
    double z = nearest(centre);
    double step = centre >= z ? 1.0 : -1.0;
    while (++nodes_ < kMostNodes) {
      const double off = centre - z;
      const double here = norm + off * off / D_(k);
      if (!(here < bound())) return;
      z_(k) = z;
      if (k == 0) {
        keep(here);
      } else {
        shifts_.col(k - 1).head(k) = shifts_.col(k).head(k) + (z - centre) * Lt_.col(k).head(k);
        descend(k - 1, here);
      }
      z += step;
      step = -step - std::copysign(1.0, step);
    }
  }
  void keep(double norm) {
    auto at = found_.begin();
    while (at != found_.end() && at->norm <= norm) ++at;
    found_.insert(at, {z_, norm});
    if (found_.size() > wanted_) found_.pop_back();
  }

  const MatrixXd Lt_;
  const VectorXd& D_;
  VectorXd float_;
  VectorXd z_;
  MatrixXd shifts_;  ///< column k: of the ambiguities up to k by the integers chosen above
  std::size_t wanted_;
  std::vector<Candidate> found_;
  long nodes_ = 0;
};

}  // namespace

double IntegerSolutions::ratio() const {
  if (squared_norms.size() < 2) return 0.0;
  return squared_norms(0) > 0.0 ? squared_norms(1) / squared_norms(0) : std::numeric_limits<double>::infinity();
}

IntegerSolutions integer_least_squares(const VectorXd& a, const MatrixXd& Q, int count, double least_success) {
  if (a.size() == 0 || Q.rows() != a.size() || Q.cols() != a.size() || count < 1)
    throw std::invalid_argument(fmt::format("integer_least_squares: {} ambiguities, a {} x {} covariance, {} candidates",
                                            a.size(), Q.rows(), Q.cols(), count));
  const Decorrelation decorrelated(Q);
  IntegerSolutions result;
  result.success_rate = 1.0;
  for (const double variance : decorrelated.D()) result.success_rate *= std::erf(0.5 / std::sqrt(2.0 * variance));
  if (result.success_rate < least_success) return result;
  // Integer cycles are subtracted first: large ones would lose digits.
  const VectorXd whole = a.array().round();
  const auto found = Search(decorrelated, decorrelated.Z().transpose() * (a - whole), count).run();
  result.candidates.resize(a.size(), static_cast<Index>(found.size()));
  result.squared_norms.resize(static_cast<Index>(found.size()));
  const Eigen::PartialPivLU<MatrixXd> back(decorrelated.Z().transpose());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto column = static_cast<Index>(i);
    result.candidates.col(column) = whole + back.solve(found[i].z).array().round().matrix();
    result.squared_norms(column) = found[i].norm;
  }
  return result;
}

}  // namespace coast::carrier
