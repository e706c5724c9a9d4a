#pragma once
// The step of a sensor's output compared with its noise; private to the room.

#include "coast/noise/static_signal.hpp"

namespace coast::noise {

struct Resolution {
  double step = 0.0;     ///< smallest distance between two values that occur; 0: too many different values to find one
  double scatter = 0.0;  ///< white noise from sample to sample, rounding included
  /// Rounding adds step^2/12 to the variance up to a step of two sigma (Sheppard's correction; Widrow & Kollar 2008, ch. 4 and
  /// 5); beyond it the variance does not determine the noise before rounding.
  [[nodiscard]] bool hides_the_noise() const { return step > 2.0 * scatter; }
};

/// Standard deviation of the white noise from sample to sample, by half the mean square of their changes: slow errors have no
/// effect.
[[nodiscard]] double white_scatter(const StaticSignal& signal);
[[nodiscard]] Resolution resolution_of(const StaticSignal& signal);

}  // namespace coast::noise
