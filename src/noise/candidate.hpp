#pragma once
// One sum of processes fitted and scored, and the choice of the best. Private to the room.

#include <optional>
#include <vector>

#include "coast/noise/calibration.hpp"
#include "short_likelihood.hpp"

namespace coast::noise {

/// Fits one sum: start from the Allan curve and from the optima of other sums, then maximum likelihood, for a long record by
/// ShortLikelihood.
/// @param starts  further start values of u
[[nodiscard]] Candidate fit_candidate(const std::vector<StaticSignal>& records, const AllanCurve& curve, const SumModel& model,
                                      const std::vector<std::vector<double>>& starts);

/// Fits from one start only, for a long record by ShortLikelihood: never below the start.
[[nodiscard]] Candidate fit_from(const std::vector<StaticSignal>& records, const SumModel& model,
                                 const std::vector<double>& start);

/// Least gain of a parameter in twice the log-likelihood. A parameter of a process that is not needed is at the end of its
/// range, and the ratio's distribution is half chi2(0), half chi2(1) (uncertainty.hpp): in 0.5 and 2.5 % of the records without
/// the process the gain is as large by chance.
struct LeastGain {
  static constexpr double kUsual = 6.635;         ///< 99 % of chi2(1)
  static constexpr double kContradicted = 3.841;  ///< 95 %: if the record's Allan curve contradicts a sum
};

/// Processes with only few correlation times in a record; for all others every sample is informative.
[[nodiscard]] const std::vector<const Estimable*>& slow_processes();

/// Penalty of the parameters of the processes. A parameter of white noise, of quantisation or of an autoregression costs the
/// logarithm of the number of samples (Schwarz 1978). A parameter of a slow process costs the logarithm of the number of
/// independent squares that determine it: with log(samples), a process of which the record has a dozen correlation times
/// would need the same gain as one that every sample determines. Flicker noise has a fixed band of correlation times
/// and one parameter only: it costs as much as a Gauss-Markov process, so that the likelihood decides between the two.
/// @param independent  for each parameter, from independent_squares
/// @param samples      upper bound of these
[[nodiscard]] double penalty(const SumModel& model, const std::vector<double>& independent, double samples,
                             double least_gain = LeastGain::kUsual);

/// 2/variance by the Cramer-Rao bound; 0 if there is no information.
[[nodiscard]] std::vector<double> independent_squares(const Eigen::MatrixXd& information);

/// Completes a fit by ShortLikelihood: processes without effect, the log-likelihood used for comparison,
/// the criteria.
void complete(const Likelihood& likelihood, const ShortLikelihood& shortened, Candidate& candidate);

/// Counts the parameters and sets the criteria from the log-likelihood used for comparison.
/// @param information  of the processes' parameters at the fit
void score(const Likelihood& likelihood, const Eigen::MatrixXd& information, Candidate& candidate);
/// After the log-likelihood used for comparison has changed.
void score_again(const Likelihood& likelihood, Candidate& candidate);

/// Log-likelihood per sample of each half of the records with the parameters fitted to the other half.
[[nodiscard]] double held_out_score(const std::vector<StaticSignal>& records, const SumModel& model,
                                    const std::vector<double>& u);

/// The sum without its processes without effect; none if all have an effect.
[[nodiscard]] std::optional<SumModel> reduced(const std::vector<StaticSignal>& records, const Candidate& candidate);

/// By the criterion; a sum with a process without effect ranks below all others, and one compared on extracts below those
/// compared on all samples.
[[nodiscard]] bool better(const Candidate& a, const Candidate& b, Criterion criterion);

/// Index of the best.
[[nodiscard]] std::size_t choose(const std::vector<Candidate>& candidates, Criterion criterion);

}  // namespace coast::noise
