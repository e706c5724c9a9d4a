#pragma once
// Estimators of a sum of processes from static records: constrained EM, direct maximum likelihood, wavelet moments, Allan least
// squares. All use the same model and the same parameters u.

#include <functional>
#include <vector>

#include "coast/noise/allan.hpp"
#include "coast/noise/likelihood.hpp"

namespace coast::noise {

/// Parameters that keep their start value.
using FixedParameters = std::vector<bool>;

/// Result of an estimator, and its course.
struct Fit {
  std::vector<double> u;
  double log_likelihood = 0.0;
  /// Best log-likelihood after each iteration; for EM, that at the parameters of each E-step; for the direct search on the full
  /// record, after each evaluation, then after each accepted step.
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
/// closed-form M-step of each process. The E-step is that of the restricted likelihood: level and drift belong to the
/// unobserved variables, without prior, so that the log-likelihood never decreases.
/// @note Convergence is very slow near the optimum; a variance whose optimum is zero decreases like 1/k and never reaches it
/// @throws NumericalError  the log-likelihood is not finite at the start
[[nodiscard]] Fit fit_em(const Likelihood& likelihood, const std::vector<double>& start, const EmOptions& options = {});

struct MaximumLikelihoodOptions {
  FixedParameters fixed = {};
  double tolerance = 1e-7;  ///< gain of log-likelihood that the quadratic model still predicts
  bool pyramid = true;      ///< for a long record, search first on block means and on its beginning
  bool polished = true;     ///< false: stop after that; the log-likelihood is then that of the extracts
  std::function<void(double)> progress = {};
};
/// Direct maximum likelihood: L-BFGS-B in u (logarithms) with the exact gradient on block means, then on the full record
/// Gauss-Newton steps with the information matrix from the same pass, damped until the log-likelihood rises. Parameters stay in
/// the model's ranges; a variance at its lower end is effectively zero.
[[nodiscard]] Fit fit_maximum_likelihood(const Likelihood& likelihood, const std::vector<double>& start,
                                         const MaximumLikelihoodOptions& options = {});

/// Least squares between a curve and that of the model.
enum class CurveFit {
  kWaveletMoments,  ///< variances, weighted by their own (Guerrier et al. 2013, GMWM with a diagonal weight)
  kAllan,  ///< logarithms of Allan deviations at octaves, equal weights: corresponds to the usual fit by eye or spreadsheet
};
/// Searches rates (beta) over a grid, variances by non-negative least squares for each, and refines the best.
/// @return u within the model's ranges; a variance that does not improve the fit is at the lower end
[[nodiscard]] std::vector<double> fit_curve(const AllanCurve& curve, const SumModel& model, const SignalScale& scale,
                                            CurveFit kind);

/// Allan curve of a signal with holes, from averages that have at least 3/4 of their samples.
/// @note a fraction p of samples missing at random raises the variance of white noise by 1/(1 - p), not that of slow processes
[[nodiscard]] AllanCurve allan_curve(const StaticSignal& signal, const AllanOptions& options = {});

}  // namespace coast::noise
