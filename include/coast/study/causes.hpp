#pragma once
// Possible causes if a recording does not fit: errors in its description, ranked by the likelihood of two minutes of data.

#include <string>
#include <vector>

#include "coast/study/mission.hpp"

namespace coast::study {

/// Two minutes that begin 20 s before the vehicle has moved by 10 m, in body axes, thinned: increments are summed over at most
/// 0.02 s (never across a gap), fixes are at least 0.45 s apart.
struct Excerpt {
  record::ImuRecording imu;
  record::GnssRecording gnss;
};
[[nodiscard]] Excerpt excerpt_of(const record::ImuRecording& imu, const record::GnssRecording& gnss);

/// One change in how the recording is read or modelled, with the gain in likelihood.
struct Cause {
  std::string what;         ///< "the sign of gyro x is turned", with value and sigma if one is estimated
  std::string remedy;       ///< what to write in the run file, or to do
  double gain = 0.0;        ///< gain of log-likelihood relative to the recording as described
  bool of_samples = false;  ///< signs, axes or units of the IMU are others than described
};

/// Aligns and filters the excerpt as described and under each hypothesis of a table (signs and exchanged axes of the gyro,
/// units, lever arm, time offset, leap seconds), without gate. Time offset and lever arm are estimated in all of them if the
/// setup leaves them to the data. Likelihoods are concentrated over one factor on all noise, -N/2 log(NIS/N) instead of -NIS/2
/// (Harvey 1989, section 3.4.1), and over factors on the IMU's noise alone, so that noise stated too small does not affect the
/// ranking. Returns the hypotheses with a gain, the likeliest first; the noise last, unless it is left to the data. If the
/// excerpt as described cannot be aligned: those that fit, with gains relative to the least likely of the others.
/// @param stated  the setup before anything was adapted
[[nodiscard]] std::vector<Cause> rank_causes(const Excerpt& excerpt, const Setup& stated);

}  // namespace coast::study
