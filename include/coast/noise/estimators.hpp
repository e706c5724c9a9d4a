#pragma once
// Estimators of a sum of processes from static records: constrained EM, direct maximum likelihood, wavelet moments, Allan least
// squares. All on the same model and the same parameters u.

#include <functional>
#include <vector>

#include "coast/noise/allan.hpp"
#include "coast/noise/likelihood.hpp"

namespace coast::noise {

/// Parameters that stay where they start.
using FixedParameters = std::vector<bool>;

/// Where an estimator ended, and how it came there.
struct Fit {
  std::vector<double> u;
  double log_likelihood = 0.0;
  /// Best log-likelihood after each iteration; of EM, that at the parameters of each E-step; of the direct search on the full
  /// record after each evaluation, then after each step that was taken.
  std::vector<double> trace;
  int passes = 0;  ///< over the record at full rate: values, gradients and E-steps
  bool converged = false;
};

struct EmOptions {
  int iterations = 20;
  double tolerance = 1e-9;     ///< gain of log-likelihood per iteration, below which it has converged
  FixedParameters fixed = {};  ///< empty: all free
  std::function<void(double)> progress = {};
};
/// Constrained EM (Shumway & Stoffer 1982; Holmes 2010; Stebler et al. 2011): E-step by the smoother with lag-one covariances,
/// closed-form M-step of each process. The E-step is that of the restricted likelihood: level and drift are part of what is not
/// observed, without prior, so that log-likelihood never falls.
/// @note close to the optimum it slows to a crawl, and a variance whose optimum is zero it approaches like 1/k, never reaching
/// it
/// @throws NumericalError  the log-likelihood is not finite at the start
[[nodiscard]] Fit fit_em(const Likelihood& likelihood, const std::vector<double>& start, const EmOptions& options = {});

struct MaximumLikelihoodOptions {
  FixedParameters fixed = {};
  double tolerance = 1e-7;  ///< log-likelihood that the quadratic model still promises
  bool pyramid = true;      ///< search a long record on block means and its beginning first
  bool polished = true;     ///< false: leave it at that; the log-likelihood is then of what was searched
  std::function<void(double)> progress = {};
};
/// Direct maximum likelihood: L-BFGS-B in u (logarithms) with the exact gradient on block means, then on the full record
/// Gauss-Newton steps with the information that the same pass gives, damped until the log-likelihood rises. Parameters stay in
/// the model's ranges; a variance at its lower end is as good as zero.
[[nodiscard]] Fit fit_maximum_likelihood(const Likelihood& likelihood, const std::vector<double>& start,
                                         const MaximumLikelihoodOptions& options = {});

/// Least squares between a curve and the model's.
enum class CurveFit {
  kWaveletMoments,  ///< variances, weighted by their own (Guerrier et al. 2013, GMWM with a diagonal weight)
  kAllan,           ///< logarithms of Allan deviations at octaves, all alike: what is usually done by eye or by Excel
};
/// Searches rates (beta) over a grid, variances by non-negative least squares for each, and refines the best.
/// @return u within the model's ranges; a variance that the curve does not want is at the lower end
[[nodiscard]] std::vector<double> fit_curve(const AllanCurve& curve, const SumModel& model, const SignalScale& scale,
                                            CurveFit kind);

/// Allan curve of a signal with its holes.
[[nodiscard]] AllanCurve allan_curve(const StaticSignal& signal, const AllanOptions& options = {});

}  // namespace coast::noise
