#pragma once
// Power spectral density of a record and of a sum of processes. Private to the room.

#include <optional>
#include <vector>

#include "coast/noise/likelihood.hpp"

namespace coast::noise {

/// Periodogram of one or several records in bins that are narrow at low frequencies (a hundredth of the frequency) and never
/// wider than a thousandth of half the sample rate.
struct Spectrum {
  struct Bin {
    double frequency = 0.0;  ///< Hz, at its centre
    double width = 0.0;      ///< Hz
    double density = 0.0;    ///< mean over its lines; equals the variance per sample for a white record
    double lines = 0.0;
  };
  double interval = 0.0;  ///< s between samples
  std::vector<Bin> bins;
};
/// With a Hann window over the whole record against leakage of a random walk's power to higher frequencies. Holes are closed.
[[nodiscard]] Spectrum spectrum_of(const std::vector<Detrended>& records);

/// Log-likelihood of a spectrum under a sum of processes (Whittle 1953): every line of the periodogram an independent
/// chi-square variable of two degrees of freedom about the sum's density. An approximation that costs the number of bins
/// instead of the number of samples: for ranking and for start values.
[[nodiscard]] double spectral_value(const Spectrum& spectrum, const SumModel& model, const std::vector<double>& u);
[[nodiscard]] LikelihoodSlope spectral_slope(const Spectrum& spectrum, const SumModel& model, const std::vector<double>& u);

/// A band in which a record has more power than a sum of processes.
struct Band {
  double centre = 0.0;    ///< Hz
  double width = 0.0;     ///< Hz
  double variance = 0.0;  ///< [signal]^2, of the excess over the sum
  double sigmas = 0.0;    ///< significance of the excess, from the scatter of the lines
};
/// The most significant one, up to a sixteenth of all frequencies wide; none if none reaches six sigmas.
[[nodiscard]] std::optional<Band> strongest_band(const Spectrum& spectrum, const SumModel& model, const std::vector<double>& u);

}  // namespace coast::noise
