#pragma once
// Delay between two sets of signals from their spectra. Private to the room.

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace coast::array {

/// One column per axis, one row per sample.
using LagSamples = Eigen::MatrixXd;

/// Subtracts mean and trend from every column.
void detrend(LagSamples& samples);

/// Integer samples by which b is late relative to a, at the largest normalised correlation within +-most.
/// @param b  has `most` rows more than a at both ends
[[nodiscard]] Eigen::Index whole_lag(const LagSamples& a, const LagSamples& b, Eigen::Index most);

/// A lag in samples, and its uncertainty.
struct FineLag {
  double lag = 0.0;
  double sigma = 0.0;
  double coherence = 0.0;
  double rms_frequency = 0.0;  ///< rad per sample
  double significance = 0.0;   ///< of the coherence, in sigmas of its distribution by chance
};
/// Within +-2 samples. Both of the same length.
[[nodiscard]] FineLag fine_lag(LagSamples a, LagSamples b);

}  // namespace coast::array
