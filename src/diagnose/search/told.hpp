#pragma once
// Report on an effect when it is selected; private to the room.

#include <optional>
#include <vector>

#include "search/candidates.hpp"

namespace coast::diagnose {

/// @param h  of the suspicion  @param candidates  among which it was chosen
[[nodiscard]] Finding finding_of(const Suspicion& s, const Hypothesis& h, const State& state, const Candidates& candidates);
/// @param fits  for one axis, the first is selected
[[nodiscard]] NoiseFinding noise_finding_of(const std::vector<FittedEffect>& fits, double p_value, const State& state);

/// Alternatives are reported, with the larger of the two odds, if both by the data alone and with the prior they are more than
/// a thousandth as likely: with only one condition, an effect hardly likelier than none would list the whole catalogue.
[[nodiscard]] std::optional<double> log_odds_told(double by_data, double by_evidence);

}  // namespace coast::diagnose
