#pragma once
// Forms of errors that the disturbances suggest and the catalogue lacks; private to the room.

#include <optional>

#include "coast/diagnose/examination.hpp"
#include "mission_run.hpp"

namespace coast::diagnose {

/// An effect that a recording suggests.
struct Proposal {
  EffectPtr effect;
  double likelihood_ratio = 0.0;  ///< twice the logarithm, against none
  double p_value = 1.0;           ///< that the largest of all that were looked at is as large by chance
  double log_places = 0.0;        ///< logarithm of how many those are
  double stability = 1.0;         ///< share of random halves of the mission in which it is among the likeliest
};

/// The strongest spectral line of an axis: the periodogram of the disturbances over that of the draws.
[[nodiscard]] std::optional<Proposal> strongest_line(const Examination& examination);

/// The likeliest of all relations between an axis and products of signals, by its score. Stability as Meinshausen & Buehlmann
/// (2010): the same search on halves of the mission, in blocks.
[[nodiscard]] std::optional<Proposal> likeliest_relation(const Examination& examination, const MissionRun& run);

}  // namespace coast::diagnose
