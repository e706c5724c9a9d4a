#pragma once
// Power over frequency: of a record, and of a sum of processes. Private to the room.

#include <optional>
#include <vector>

#include "coast/noise/likelihood.hpp"

namespace coast::noise {

/// Periodogram of one or several records in bins that are narrow at low frequencies (a hundredth of the frequency) and nowhere
/// wider than a thousandth of half the sample rate.
struct Spectrum {
  struct Bin {
    double frequency = 0.0;  ///< Hz, at its centre
    double width = 0.0;      ///< Hz
    double density = 0.0;    ///< mean over its lines; the variance per sample where the record is white
    double lines = 0.0;
  };
  double interval = 0.0;  ///< s between samples
  std::vector<Bin> bins;
};
/// Under a Hann window over the whole record, so that a random walk's power does not leak upwards. Holes are closed.
[[nodiscard]] Spectrum spectrum_of(const std::vector<Detrended>& records);

/// Log-likelihood of a spectrum under a sum of processes (Whittle 1953): every line of the periodogram an independent
/// chi-square variable of two degrees of freedom about the sum's density. An approximation that costs the number of bins
/// instead of the number of samples: for ranking and for starting.
[[nodiscard]] double spectral_value(const Spectrum& spectrum, const SumModel& model, const std::vector<double>& u);
[[nodiscard]] LikelihoodSlope spectral_slope(const Spectrum& spectrum, const SumModel& model, const std::vector<double>& u);

/// A band in which a record has more power than a sum of processes.
struct Band {
  double centre = 0.0;    ///< Hz
  double width = 0.0;     ///< Hz
  double variance = 0.0;  ///< [signal]^2, of what is above the sum
  double sigmas = 0.0;    ///< of the excess, by the scatter of the lines
};
/// The most significant one, up to a sixteenth of all frequencies wide; nothing where none has six sigmas.
[[nodiscard]] std::optional<Band> strongest_band(const Spectrum& spectrum, const SumModel& model, const std::vector<double>& u);

}  // namespace coast::noise
