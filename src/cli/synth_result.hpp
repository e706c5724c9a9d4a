#pragma once
// What `coast synth` found, for the files and the page.

#include <optional>
#include <string>
#include <vector>

#include "array_config.hpp"
#include "coast/array/remaining.hpp"
#include "coast/array/sensor_times.hpp"
#include "coast/noise/residual_tests.hpp"

namespace coast::cli {

/// Errors of a channel against a reference, mean taken off: standard deviations.
struct ChannelErrors {
  std::vector<double> sensors;
  double plain = 0.0;   ///< of the plain mean
  double merged = 0.0;  ///< of what was written
};

struct SynthResult {
  std::vector<std::string> sources;          ///< files of the IMUs
  std::vector<array::TimedRecording> timed;  ///< of IMUs that came as packets; empty otherwise
  std::optional<array::ClockFit> computer;   ///< of software synchronisation
  array::Assembly assembly;
  std::vector<array::MergedChannel> channels;     ///< rates x, y, z, specific forces x, y, z
  std::vector<array::RemainingErrors> remaining;  ///< likewise
  std::optional<noise::ImuErrorModel> extended;   ///< of the sum, where each IMU keeps its own error states
  std::vector<ChannelErrors> against_reference;   ///< likewise; empty without a reference
  record::Events events;
};

/// "gyro_x", ..., "accel_z"
[[nodiscard]] std::string channel_name(int channel);
/// Standard deviation of a sample's own noise: of each sensor, of their plain mean, of what was written; as the sensors'
/// differences tell.
[[nodiscard]] std::vector<double> own_sds(const array::MergedChannel& channel);
[[nodiscard]] double plain_sd(const array::MergedChannel& channel);
[[nodiscard]] double merged_sd(const array::MergedChannel& channel);

[[nodiscard]] record::ImuRecording synthetic_imu(const SynthResult& result);
/// `imu.noise_levels` of run.yaml.
[[nodiscard]] std::string noise_csv(const SynthResult& result);
[[nodiscard]] std::string synth_json(const ArrayConfig& config, const SynthResult& result);
[[nodiscard]] std::vector<std::string> synth_sentences(const ArrayConfig& config, const SynthResult& result);

}  // namespace coast::cli
