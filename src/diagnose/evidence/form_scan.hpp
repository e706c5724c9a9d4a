#pragma once
// Error forms suggested by the disturbances and not in the catalogue; private to the room.

#include <optional>

#include "coast/diagnose/examination.hpp"
#include "evidence/mission_run.hpp"

namespace coast::diagnose {

/// An effect suggested by a recording.
struct Form {
  EffectPtr effect;
  double likelihood_ratio = 0.0;  ///< twice the logarithm, relative to none
  double p_value = 1.0;           ///< that the largest of all tested ones is as large by chance
  double log_places = 0.0;        ///< logarithm of the number of tested ones
  double stability = 1.0;         ///< fraction of random halves of the mission in which it is among the likeliest
};

/// The strongest spectral line of an axis: the periodogram of the disturbances over that of the draws.
[[nodiscard]] std::optional<Form> strongest_line(const Examination& examination);

/// The likeliest of all relations between an axis and products of signals, by its score. Stability by Meinshausen & Buehlmann
/// (2010): the same search on halves of the mission, in blocks.
[[nodiscard]] std::optional<Form> likeliest_relation(const Examination& examination, const MissionRun& run);

inline constexpr std::size_t kFewestIntervals = 60;  // below, no form is reported
/// Sensor of a row of Disturbances.
[[nodiscard]] inline Site site_of(std::size_t row) {
  return row < 3 ? Site::kGyro : Site::kAccel;
}

}  // namespace coast::diagnose
