// The expected information of restricted maximum likelihood, and quantities from an information matrix.

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "coast/noise/chi_square.hpp"
#include "coast/noise/uncertainty.hpp"
#include "spectrum.hpp"

namespace coast::noise {

namespace {

/// The block with level and drift as states with a prior so wide that its information is below rounding.
SampleBlock with_mean_states(const SampleBlock& block, Mean mean, double samples) {
  const Eigen::Index n = block.h.size();
  const Eigen::Index m = coefficients(mean);
  SampleBlock wide = SampleBlock::zero(n + m);
  const auto put = [&](const Eigen::MatrixXd& from, Eigen::MatrixXd& to) { to.topLeftCorner(n, n) = from; };
  put(block.Phi, wide.Phi);
  put(block.Q, wide.Q);
  put(block.P_first, wide.P_first);
  wide.h.head(n) = block.h;
  wide.white = block.white;
  if (m == 0) return wide;
  constexpr double kWide = 1e7;  // times the variance: P_first loses half of its digits, the information one part in 1e7
  const double variance =
      kWide * (block.white + (block.h * block.P_first * block.h.transpose()).value() + samples * block.Q.trace());
  wide.h(n) = 1.0;
  wide.Phi(n, n) = 1.0;
  wide.P_first(n, n) = variance;
  if (m == 1) return wide;
  wide.Phi(n + 1, n + 1) = 1.0;
  wide.Phi(n, n + 1) = 2.0 / samples;  // over the record the drift adds twice its state
  wide.P_first(n + 1, n + 1) = variance;
  return wide;
}

SampleBlock widened(const SampleBlock& derivative, Eigen::Index size) {
  SampleBlock wide = SampleBlock::zero(size);
  const Eigen::Index n = derivative.h.size();
  wide.Phi.topLeftCorner(n, n) = derivative.Phi;
  wide.Q.topLeftCorner(n, n) = derivative.Q;
  wide.P_first.topLeftCorner(n, n) = derivative.P_first;
  wide.white = derivative.white;
  return wide;
}

/// In innovation form, a' = Phi a + g e with white e of variance S, and for d_i = da/du_i
///
///     d_i' = F d_i + M_i a + g_i e,   de_i = -h d_i,   F = Phi (I - k h),  g = Phi k,  M_i = dPhi_i,  g_i = Phi dk_i + M_i k,
///
/// the second moments A = E a a', B_i = E d_i a', D_ij = E d_i d_j' are propagated.
class InformationFilter {
 public:
  InformationFilter(const SampleBlock& block, const std::vector<SampleBlock>& derivatives)
      : block_(block), slopes_(derivatives), P_(block.P_first), A_(Eigen::MatrixXd::Zero(block.h.size(), block.h.size())) {
    for (const SampleBlock& slope : slopes_) {
      dP_.push_back(slope.P_first);
      B_.push_back(A_);
    }
    D_.assign(slopes_.size(), std::vector<Eigen::MatrixXd>(slopes_.size(), A_));
    information_.setZero(static_cast<Eigen::Index>(slopes_.size()), static_cast<Eigen::Index>(slopes_.size()));
  }

  Eigen::MatrixXd run(std::uint64_t samples) {
    for (std::uint64_t i = 0; i < samples; ++i) step();
    return information_.selfadjointView<Eigen::Lower>();
  }

 private:
  void step() {
    const Eigen::VectorXd PHt = P_ * block_.h.transpose();
    const double S = block_.h.dot(PHt) + block_.white;
    const Eigen::VectorXd k = PHt / S;
    const Eigen::MatrixXd F = block_.Phi - block_.Phi * k * block_.h;
    const Eigen::VectorXd g = block_.Phi * k;
    const std::size_t p = slopes_.size();
    std::vector<double> dS(p);
    std::vector<Eigen::VectorXd> dk(p);
    std::vector<Eigen::VectorXd> drive(p);
    for (std::size_t i = 0; i < p; ++i) {
      const Eigen::VectorXd dPHt = dP_[i] * block_.h.transpose();
      dS[i] = block_.h.dot(dPHt) + slopes_[i].white;
      dk[i] = (dPHt - k * dS[i]) / S;
      drive[i] = block_.Phi * dk[i] + slopes_[i].Phi * k;
    }
    for (std::size_t i = 0; i < p; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        const double means = (block_.h * D_[i][j] * block_.h.transpose()).value() / S;
        information_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) += means + dS[i] * dS[j] / (2.0 * S * S);
      }
    advance_moments(F, g, drive, S);
    advance_covariances(k, dk, dS, S);
  }

  void advance_moments(const Eigen::MatrixXd& F, const Eigen::VectorXd& g, const std::vector<Eigen::VectorXd>& drive,
                       double S) {
    const std::size_t p = slopes_.size();
    for (std::size_t i = 0; i < p; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        const Eigen::MatrixXd& M_i = slopes_[i].Phi;
        const Eigen::MatrixXd& M_j = slopes_[j].Phi;
        D_[i][j] = F * D_[i][j] * F.transpose() + F * B_[i] * M_j.transpose() + M_i * B_[j].transpose() * F.transpose() +
                   M_i * A_ * M_j.transpose() + S * drive[i] * drive[j].transpose();
      }
    for (std::size_t i = 0; i < p; ++i)
      B_[i] = F * B_[i] * block_.Phi.transpose() + slopes_[i].Phi * A_ * block_.Phi.transpose() + S * drive[i] * g.transpose();
    A_ = block_.Phi * A_ * block_.Phi.transpose() + S * g * g.transpose();
  }

  void advance_covariances(const Eigen::VectorXd& k, const std::vector<Eigen::VectorXd>& dk, const std::vector<double>& dS,
                           double S) {
    const Eigen::MatrixXd P_upd = P_ - S * k * k.transpose();
    for (std::size_t i = 0; i < slopes_.size(); ++i) {
      const Eigen::MatrixXd cross = S * dk[i] * k.transpose();
      const Eigen::MatrixXd dP_upd = dP_[i] - dS[i] * k * k.transpose() - cross - cross.transpose();
      const Eigen::MatrixXd moved = slopes_[i].Phi * P_upd * block_.Phi.transpose();
      dP_[i] = block_.Phi * dP_upd * block_.Phi.transpose() + moved + moved.transpose() + slopes_[i].Q;
    }
    P_ = block_.Phi * P_upd * block_.Phi.transpose() + block_.Q;
    P_ = (0.5 * (P_ + P_.transpose())).eval();
  }

  SampleBlock block_;
  std::vector<SampleBlock> slopes_;
  Eigen::MatrixXd P_;
  std::vector<Eigen::MatrixXd> dP_;
  Eigen::MatrixXd A_;
  std::vector<Eigen::MatrixXd> B_;
  std::vector<std::vector<Eigen::MatrixXd>> D_;  ///< j <= i
  Eigen::MatrixXd information_;
};

constexpr double kMostValues = 20000.0;  // for a longer record blocks are used

Eigen::MatrixXd run_filter(const SumModel& model, const std::vector<double>& u, const SampleStep& step, Mean mean,
                           std::uint64_t values) {
  const SampleBlock wide = with_mean_states(model.block(u, step), mean, static_cast<double>(values));
  std::vector<SampleBlock> derivatives;
  for (const SampleBlock& derivative : model.derivatives(u, step)) derivatives.push_back(widened(derivative, wide.h.size()));
  return InformationFilter(wide, derivatives).run(values);
}

}  // namespace

Eigen::MatrixXd expected_information(const SumModel& model, const std::vector<double>& u, double interval,
                                     std::uint64_t samples) {
  const auto all = static_cast<double>(samples);
  const std::size_t block = model.has_averages() ? std::max<std::size_t>(1, static_cast<std::size_t>(all / kMostValues)) : 1;
  const SampleStep step(interval, block);
  const std::uint64_t blocks = samples / block;
  Eigen::MatrixXd information = run_filter(model, u, step, model.mean(), blocks);
  // Within a block: the information of its samples in addition to their mean, which is counted separately.
  if (block > 1) information += static_cast<double>(blocks) * run_filter(model, u, SampleStep(interval), Mean::kLevel, block);
  return information;
}

Eigen::MatrixXd record_information(const Likelihood& likelihood, const std::vector<double>& u) {
  constexpr Eigen::Index kManyStates = 6;  // for more, the moments of all pairs of parameters take minutes
  const auto by_lines = [&] { return spectral_slope(spectrum_of(likelihood.records()), likelihood.model(), u).information; };
  const bool is_long = likelihood.samples() > kMostValues;
  if (is_long && likelihood.model().states() > kManyStates) return by_lines();
  const auto p = static_cast<Eigen::Index>(u.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(p, p);
  for (const Detrended& record : likelihood.records())
    information += expected_information(likelihood.model(), u, likelihood.interval(), record.signal.length());
  if (!is_long) return information;
  // A resonance with a decay longer than a block is not covered by blocks: lines of the spectrum are used.
  constexpr double kKnown = 4.0;
  Eigen::MatrixXd lines = by_lines();
  for (Eigen::Index i = 0; i < p; ++i)
    if (lines(i, i) > kKnown && lines(i, i) > 2.0 * information(i, i)) return lines;
  return information;
}

Eigen::MatrixXd cramer_rao(const Eigen::MatrixXd& information) {
  const Eigen::Index p = information.rows();
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(0.0).cwiseSqrt();
  std::vector<Eigen::Index> seen;
  for (Eigen::Index i = 0; i < p; ++i)
    if (scale(i) > 1e-9) seen.push_back(i);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(p, p);
  covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
  if (seen.empty()) return covariance;
  const Eigen::VectorXd unit = scale(seen).cwiseInverse();
  const Eigen::MatrixXd correlation = unit.asDiagonal() * Eigen::MatrixXd(information(seen, seen)) * unit.asDiagonal();
  const Eigen::MatrixXd inverse = correlation.ldlt().solve(Eigen::MatrixXd::Identity(correlation.rows(), correlation.rows()));
  covariance(seen, seen) = unit.asDiagonal() * inverse * unit.asDiagonal();
  return covariance;
}

double chi_bar_square_survival(double likelihood_ratio) {
  return likelihood_ratio > 0.0 ? 0.5 * chi2_survival(1.0, likelihood_ratio) : 1.0;
}

}  // namespace coast::noise
