#pragma once
// The error model of the synthetic IMU: errors that remain after merging, Stebler et al. (2011), section III.E.

#include <string>
#include <vector>

#include "coast/array/signals.hpp"
#include "coast/noise/error_model.hpp"

namespace coast::array {

/// Errors of the mean of all sensors in one channel, as far as they can be inferred from the sensors' differences.
struct RemainingErrors {
  std::vector<noise::ProcessPtr> processes;  ///< white noise, a Gauss-Markov process if selected by BIC, a constant
  std::string in_words;                      ///< "WN + GM, 2 log-likelihood 31.2 above WN alone; 5 sensors"
};

/// Each sensor's offset from the mean of all, in means over about `average_s`, is a record of white noise, or of white noise
/// and a Gauss-Markov process, with one set of parameters for all sensors (exact likelihood; BIC; K records, of which K - 1 are
/// independent, count as K - 1). Residuals of K equal sensors have (1 - 1/K) times the variance of one sensor's errors and the
/// mean has 1/K of it, so the variance of the mean is that of a residual divided by K - 1. The constant's standard deviation
/// follows in the same way from the scatter of the sensors' levels.
/// @note errors common to all sensors (e.g. of temperature on sensors of one kind) do not appear in differences
/// @param signals  with their offsets, 2 sensors or more; columns with a sensor missing are left out
/// @param white_factor  variance of the merged white noise as a share of the plain mean's
/// @param average_s  halved until there are 50 averages, down to 0.1 s, for short records
/// @throws std::invalid_argument  fewer than 2 sensors, or still fewer than 50 averages
[[nodiscard]] RemainingErrors remaining_errors(const Signals& signals, int channel, double average_s, double white_factor);

/// White noise as used by a navigation filter.  @param density  [signal]^2/Hz
[[nodiscard]] noise::ProcessPtr white_noise_of(double density, int channel);

/// The error model of six channels.
[[nodiscard]] noise::ImuErrorModel error_model_of(const std::string& name, double rate_hz,
                                                  const std::vector<RemainingErrors>& channels);
/// The same as a file for `imu.error_model` of `process`, with a comment on each channel.
[[nodiscard]] std::string error_model_yaml(const std::string& name, double rate_hz,
                                           const std::vector<RemainingErrors>& channels);

}  // namespace coast::array
