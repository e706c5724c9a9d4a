#pragma once
// The error model of the synthetic IMU: what is left after merging, Stebler et al. (2011), section III.E.

#include <string>
#include <vector>

#include "coast/array/signals.hpp"
#include "coast/noise/error_model.hpp"

namespace coast::array {

/// Errors of the mean of all sensors in one channel, as far as the sensors' differences tell.
struct RemainingErrors {
  std::vector<noise::ProcessPtr> processes;  ///< white noise, a Gauss-Markov process where BIC wants one, a constant
  std::string in_words;                      ///< "WN + GM, 2 log-likelihood 31.2 above WN alone; 5 sensors"
};

/// Each sensor's offset from the mean of all, in means over about `average_s`, is a record of white noise, or of white noise
/// and a Gauss-Markov process, with one set of parameters for all sensors (exact likelihood; BIC; the K records of which K - 1
/// are independent count as K - 1). Residuals of K like sensors have the (1 - 1/K)-fold variance of their own errors and the
/// mean has the K-th part, so the mean's is that of a residual over K - 1. The constant's standard deviation comes from how the
/// sensors' levels scatter, likewise.
/// @note what all sensors have in common (a temperature's effect on sensors of one kind) no difference shows
/// @param signals  with their offsets, 2 sensors or more; columns with a sensor missing are left out
/// @param white_factor  variance of the merged white noise as a share of the plain mean's
/// @param average_s  halved until there are 50 averages, down to 0.1 s: of a short record the model says as much as it can
/// @throws std::invalid_argument  fewer than 2 sensors, or fewer than 50 averages even so
[[nodiscard]] RemainingErrors remaining_errors(const Signals& signals, int channel, double average_s, double white_factor);

/// White noise as a navigation filter takes it.  @param density  [signal]^2/Hz
[[nodiscard]] noise::ProcessPtr white_noise_of(double density, int channel);

/// The error model of six channels.
[[nodiscard]] noise::ImuErrorModel error_model_of(const std::string& name, double rate_hz,
                                                  const std::vector<RemainingErrors>& channels);
/// The same as the file that `process` takes as `imu.error_model`, with a comment on each channel.
[[nodiscard]] std::string error_model_yaml(const std::string& name, double rate_hz,
                                           const std::vector<RemainingErrors>& channels);

}  // namespace coast::array
