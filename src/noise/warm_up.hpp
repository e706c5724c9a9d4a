#pragma once
// Warm-up of a sensor after power-on. Private to the room.

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// An exponential trend of each record that has one, in addition to level and drift: amplitude and time constant by generalised
/// least squares under the chosen sum, which is then fitted again to the remainder. Used if the gain exceeds log(samples): a
/// trend has two parameters of its own.
[[nodiscard]] std::vector<WarmUp> warm_ups_of(const std::vector<StaticSignal>& records, const Candidate& chosen);

}  // namespace coast::noise
