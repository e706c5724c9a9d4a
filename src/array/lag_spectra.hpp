#pragma once
// Delay between two sets of signals from their spectra. Private to the room.

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace coast::array {

/// One column per axis, one row per sample.
using LagSamples = Eigen::MatrixXd;

/// Takes mean and trend off every column.
void detrend(LagSamples& samples);

/// Whole samples by which b is late against a, at the largest normalised correlation within +-most.
/// @param b  has `most` rows more at both ends than a
[[nodiscard]] Eigen::Index whole_lag(const LagSamples& a, const LagSamples& b, Eigen::Index most);

/// A lag in samples, and how well it is known.
struct FineLag {
  double lag = 0.0;
  double sigma = 0.0;
  double coherence = 0.0;
  double rms_frequency = 0.0;  ///< rad per sample
  double significance = 0.0;   ///< of the coherence, in sigmas of what chance gives
};
/// Within +-2 samples. Both as long as each other.
[[nodiscard]] FineLag fine_lag(LagSamples a, LagSamples b);

}  // namespace coast::array
