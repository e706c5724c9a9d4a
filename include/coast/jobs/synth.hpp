#pragma once
// Several IMUs -> one synthetic IMU.

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coast/array/assembly.hpp"
#include "coast/array/clock.hpp"
#include "coast/array/remaining.hpp"
#include "coast/array/sensor_times.hpp"
#include "coast/array/synthetic.hpp"
#include "coast/config/node.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/packets.hpp"
#include "coast/jobs/job.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/noise/residual_tests.hpp"

namespace coast::jobs {

struct ArrayImu {
  std::string name;
  std::variant<io::ImuFileOptions, io::PacketFileOptions> file;
  array::Counting counting;  ///< of packets
  array::SensorFrame frame;
  std::optional<noise::ImuErrorModel> model;  ///< of its own error states
};

enum class TimeSource {
  kTags,     ///< the files' time columns
  kPackets,  ///< counters, and arrival times at a computer whose clock is determined by a master with GPS
  kPulses,   ///< counters, and sync pulses
};

/// array.yaml
struct ArrayConfig {
  config::Node root;
  std::filesystem::path file;
  std::vector<ArrayImu> imus;
  TimeSource time = TimeSource::kTags;
  int week = 0;              ///< of packets
  std::size_t master = 0;    ///< index of the IMU whose packets carry GPS time
  array::PulseTrain pulses;  ///< s of week
  array::AssemblyOptions assembly;
  array::MergeOptions merge;
  std::optional<io::ImuFileOptions> reference;  ///< true rates and forces, body axes at the origin
};

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] ArrayConfig read_synth(const std::filesystem::path& file);
[[nodiscard]] ArrayConfig read_synth(const config::Node& root);

/// The array.yaml of the help page, every line preceded by `indent`.
[[nodiscard]] std::string array_example(const std::string& indent);

/// Errors of a channel relative to a reference, mean removed: standard deviations.
struct ChannelErrors {
  std::vector<double> sensors;
  double plain = 0.0;   ///< of the plain mean
  double merged = 0.0;  ///< of the merged signal
};

struct SynthResult {
  std::vector<std::string> sources;          ///< files of the IMUs
  std::vector<array::TimedRecording> timed;  ///< of IMUs recorded as packets; empty otherwise
  std::optional<array::ClockFit> computer;   ///< of software synchronisation
  array::Assembly assembly;
  std::vector<array::MergedChannel> channels;     ///< rates x, y, z, specific forces x, y, z
  std::vector<array::RemainingErrors> remaining;  ///< likewise
  std::optional<noise::ImuErrorModel> extended;   ///< of the sum, if each IMU keeps its own error states
  std::vector<ChannelErrors> against_reference;   ///< likewise; empty without a reference
  record::Events events;
};

/// @throws InputError  recordings that are too short or do not overlap in time  @throws NumericalError
[[nodiscard]] SynthResult synth(const ArrayConfig& config, const Progress& progress);
/// The same for recordings in memory, in the order of config.imus, each in its own axes and with its times.
/// @param reference  true rates and specific forces
[[nodiscard]] SynthResult synth(const ArrayConfig& config, const std::vector<record::ImuRecording>& recordings,
                                const std::optional<record::ImuRecording>& reference, const Progress& progress);
/// The merged IMU, in body axes.
[[nodiscard]] record::ImuRecording synthetic_imu(const SynthResult& result);

[[nodiscard]] std::vector<std::string> files_of(const ArrayConfig& config);
/// imu.csv, noise.csv, error_model.yaml, synth.json (docs/schema/synth.schema.json), array.resolved.yaml, members.csv of
/// `extended`, report.html.
void write(const ArrayConfig& config, const SynthResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const ArrayConfig& config, const SynthResult& result, const std::filesystem::path& folder);

}  // namespace coast::jobs
