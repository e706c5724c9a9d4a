#pragma once
// A merged array as files and text.

#include <string>
#include <vector>

#include "coast/jobs/synth.hpp"

namespace coast::jobs {

/// "gyro_x", ..., "accel_z"
[[nodiscard]] std::string channel_name(int channel);
/// Standard deviation of a sample's own noise: of each sensor, of their plain mean, of the written signal; from the sensors'
/// differences.
[[nodiscard]] std::vector<double> own_sds(const array::MergedChannel& channel);
[[nodiscard]] double plain_sd(const array::MergedChannel& channel);
[[nodiscard]] double merged_sd(const array::MergedChannel& channel);

/// `imu.noise_levels` of run.yaml.
[[nodiscard]] std::string noise_csv(const SynthResult& result);
[[nodiscard]] std::string synth_json(const ArrayConfig& config, const SynthResult& result);
[[nodiscard]] std::vector<std::string> synth_sentences(const ArrayConfig& config, const SynthResult& result);

/// "synthetic IMU of 4, corrected"
[[nodiscard]] std::string synthetic_name(const ArrayConfig& config);

}  // namespace coast::jobs
