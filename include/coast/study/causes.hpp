#pragma once
// What would explain a recording that does not fit: mistakes in its description, ranked by the likelihood of two minutes.

#include <string>
#include <vector>

#include "coast/study/mission.hpp"

namespace coast::study {

/// Two minutes that begin 20 s before the vehicle has moved by 10 m, in body axes, thinned: increments are added up to at most
/// 0.02 s (never across a gap), fixes are taken 0.45 s apart and more.
struct Excerpt {
  record::ImuRecording imu;
  record::GnssRecording gnss;
};
[[nodiscard]] Excerpt excerpt_of(const record::ImuRecording& imu, const record::GnssRecording& gnss);

/// One change of how the recording is read or modelled, with what it explains.
struct Cause {
  std::string what;    ///< "the sign of gyro x is turned", with number and sigma where one is estimated
  std::string remedy;  ///< what to write in the run file, or to do
  double gain = 0.0;   ///< of the log-likelihood over the recording as it is described
};

/// Aligns and filters the excerpt as described and under each hypothesis of a table (signs and exchanged axes of the gyro,
/// units, lever arm, time offset, leap seconds), the gate open. Time offset and lever arm are free in all of them where the
/// setup leaves them to the data. Likelihoods are concentrated over one factor on all noise, -N/2 log(NIS/N) in place of -NIS/2
/// (Harvey 1989, section 3.4.1), and over factors on the IMU's alone, so that noise stated too small does not decide. Those
/// that explain anything, the likeliest first; last the noise, unless it is left to the data. Where the excerpt as
/// described cannot be aligned: those that fit, against the least likely of the rest.
/// @param stated  the setup before anything was adapted
[[nodiscard]] std::vector<Cause> rank_causes(const Excerpt& excerpt, const Setup& stated);

}  // namespace coast::study
