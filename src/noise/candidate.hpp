#pragma once
// One sum of processes fitted and scored, and which of several is the best. Private to the room.

#include <optional>

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// Fits one sum: start from the Allan curve and from what other sums found, then maximum likelihood, of a long record on what
/// ShortLikelihood keeps of it.
/// @param starts  further start values of u
[[nodiscard]] Candidate fit_candidate(const std::vector<StaticSignal>& records, const AllanCurve& curve, const SumModel& model,
                                      const std::vector<std::vector<double>>& starts);

/// Counts the parameters and sets the criteria from the log-likelihood that is compared.
void score(const Likelihood& likelihood, Candidate& candidate);

/// Log-likelihood per sample of each half of the records with what the other was fitted to.
[[nodiscard]] double held_out_score(const std::vector<StaticSignal>& records, const SumModel& model,
                                    const std::vector<double>& u);

/// A sum without the processes that say nothing of a fit; nothing where all of them speak.
[[nodiscard]] std::optional<SumModel> reduced(const std::vector<StaticSignal>& records, const Candidate& candidate);

/// By the criterion; a sum with a process that says nothing stands behind any other, and what was compared on extracts behind
/// what was compared on all samples.
[[nodiscard]] bool better(const Candidate& a, const Candidate& b, Criterion criterion);

/// Index of the best.
[[nodiscard]] std::size_t choose(const std::vector<Candidate>& candidates, Criterion criterion);

}  // namespace coast::noise
