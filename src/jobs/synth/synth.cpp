#include "coast/jobs/synth.hpp"

#include <fmt/format.h>

#include <cmath>
#include <mutex>

#include "coast/array/extended.hpp"
#include "coast/array/resample.hpp"
#include "coast/parallel.hpp"
#include "common/tell.hpp"
#include "synth/config.hpp"
#include "synth/result.hpp"

namespace coast::jobs {

namespace {

record::ImuRecording read_tagged(const ArrayConfig& config, std::size_t k, std::optional<geo::GpsTime> near) {
  const ArrayImu& imu = config.imus[k];
  return io::read_imu(std::get<io::ImuFileOptions>(imu.file), near);
}

/// First the clocks, then every device's samples with their times.
std::vector<record::ImuRecording> read_packet_imus(const ArrayConfig& config, SynthResult& result) {
  std::vector<record::PacketRecording> packets;
  for (const ArrayImu& imu : config.imus) packets.push_back(io::read_packets(std::get<io::PacketFileOptions>(imu.file)));
  if (config.time == TimeSource::kPackets)
    result.computer = array::computer_clock_of(packets[config.master], config.imus[config.master].counting);
  std::vector<record::ImuRecording> recordings;
  for (std::size_t k = 0; k < packets.size(); ++k) {
    const array::Counting& counting = config.imus[k].counting;
    result.timed.push_back(config.time == TimeSource::kPackets
                               ? array::time_by_packets(packets[k], counting, *result.computer, config.week)
                               : array::time_by_pulses(packets[k], counting, config.pulses, config.week));
    recordings.push_back(result.timed.back().imu);
  }
  return recordings;
}

std::vector<record::ImuRecording> read_imus(const ArrayConfig& config, SynthResult& result, const Progress& progress) {
  std::vector<record::ImuRecording> recordings;
  if (config.time == TimeSource::kTags) {
    for (std::size_t k = 0; k < config.imus.size(); ++k) {
      progress("reading", static_cast<double>(k) / static_cast<double>(config.imus.size()));
      recordings.push_back(read_tagged(config, k, k == 0 ? std::nullopt : std::optional(recordings.front().samples.front().t)));
    }
  } else {
    progress("reading", 0.0);
    recordings = read_packet_imus(config, result);
  }
  return recordings;
}

double sd_about_mean(const Eigen::Ref<const Eigen::RowVectorXd>& errors) {
  return std::sqrt((errors.array() - errors.mean()).square().mean());
}

ChannelErrors errors_against(const Eigen::RowVectorXd& truth, const array::Signals& signals, int c,
                             const array::MergedChannel& merged) {
  ChannelErrors errors;
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(truth.size());
  for (const array::SensorSignals& sensor : signals.sensors) {
    errors.sensors.push_back(sd_about_mean(sensor.values.row(c) - truth));
    mean += sensor.values.row(c) / static_cast<double>(signals.sensors.size());
  }
  errors.plain = sd_about_mean(mean - truth);
  errors.merged = sd_about_mean(merged.value.transpose() - truth);
  return errors;
}

std::vector<array::ModelledSensor> modelled_sensors(const ArrayConfig& config, const array::Assembly& assembly) {
  std::vector<array::ModelledSensor> sensors;
  for (std::size_t k = 0; k < config.imus.size(); ++k)
    sensors.push_back({config.imus[k].name, &*config.imus[k].model,
                       assembly.mounting ? assembly.mounting->sensors[k].frame.C_s_b : config.imus[k].frame.C_s_b});
  return sensors;
}

void merge_all(const ArrayConfig& config, const std::optional<record::ImuRecording>& truth_recording, SynthResult& result,
               const Progress& progress) {
  constexpr double kAverage = 1.0;  // s: slow errors are found from means over this
  const array::Assembly& assembly = result.assembly;
  const array::Signals& signals = assembly.signals;
  std::optional<array::SensorSignals> reference;  // true values on the grid of the array
  if (truth_recording) reference = array::resample(*truth_recording, {signals.start, signals.dt, signals.samples()});
  result.channels.resize(array::kChannels);
  result.remaining.resize(array::kChannels);
  if (reference) result.against_reference.resize(array::kChannels);
  array::MergeOptions options = config.merge;
  if (options.merge == array::Merge::kExtended) {
    const std::vector<array::ModelledSensor> sensors = modelled_sensors(config, assembly);
    options.weights = array::extended_weights(sensors);
    result.extended = array::extended_error_model(synthetic_name(config), 1.0 / assembly.signals.dt, sensors);
  }
  std::mutex mutex;
  double done = 0.0;
  coast::parallel_for(0, array::kChannels, [&](int c) {
    const auto at = static_cast<std::size_t>(c);
    std::optional<Eigen::VectorXd> truth;
    if (reference) truth = reference->values.row(c).transpose();
    result.channels[at] = array::merge_channel(assembly.levelled, c, options, truth);
    if (reference) result.against_reference[at] = errors_against(truth->transpose(), assembly.levelled, c, result.channels[at]);
    if (result.extended) {
      result.remaining[at].in_words = "error states of each IMU";
      result.channels[at].value = array::with_offsets(assembly.signals, assembly.levelled, c, result.channels[at].value,
                                                      options.weights.row(c).transpose());
    } else {
      result.remaining[at] = array::remaining_errors(assembly.signals, c, kAverage, array::white_share(result.channels[at]));
    }
    const std::scoped_lock lock(mutex);
    done += 1.0 / array::kChannels;
    progress("merging", done);
  });
}

/// Two IMUs never give the same numbers: it is one recording under two names, of which nothing can be learnt about noise.
void require_different(const ArrayConfig& config, const array::Signals& signals) {
  constexpr double kSame = 1e-9;  // relative: above rounding, far below the last digit of any sensor
  for (std::size_t k = 1; k < signals.sensors.size(); ++k)
    for (std::size_t i = 0; i < k; ++i) {
      const auto &a = signals.sensors[i].values, &b = signals.sensors[k].values;
      if ((a - b).norm() <= kSame * a.norm())
        throw config.root.error(fmt::format("{} and {} give the same samples", config.imus[i].name, config.imus[k].name),
                                "a recording of its own for each IMU", "Is one file, or one topic, named twice?");
    }
}

SynthResult merged(const ArrayConfig& config, const std::vector<record::ImuRecording>& recordings,
                   const std::optional<record::ImuRecording>& reference, SynthResult result, const Progress& progress) {
  for (const record::ImuRecording& recording : recordings) {
    result.sources.push_back(recording.source);
    result.events.insert(result.events.end(), recording.events.begin(), recording.events.end());
  }
  std::vector<array::ArrayMember> members;
  for (std::size_t k = 0; k < recordings.size(); ++k)
    members.push_back({config.imus[k].name, &recordings[k], config.imus[k].frame});
  result.assembly = array::assemble(members, config.assembly, [&](const char* what, double share) { progress(what, share); });
  require_different(config, result.assembly.signals);
  result.events.insert(result.events.end(), result.assembly.events.begin(), result.assembly.events.end());
  merge_all(config, reference, result, progress);
  tell_warnings(result.events, progress);
  return result;
}

// Recordings that are too short, or have no time in common.
template <class Job>
SynthResult or_bad_input(const ArrayConfig& config, Job job) {
  try {
    return job();
  } catch (const std::invalid_argument& error) {
    throw config.root.error(error.what(), "recordings that can be merged", "Are the files those of one mission?");
  }
}

}  // namespace

SynthResult synth(const ArrayConfig& config, const Progress& progress) {
  return or_bad_input(config, [&] {
    SynthResult result;
    const std::vector<record::ImuRecording> recordings = read_imus(config, result, progress);
    std::optional<record::ImuRecording> reference;
    if (config.reference) reference = io::read_imu(*config.reference, recordings.front().samples.front().t);
    return merged(config, recordings, reference, std::move(result), progress);
  });
}

SynthResult synth(const ArrayConfig& config, const std::vector<record::ImuRecording>& recordings,
                  const std::optional<record::ImuRecording>& reference, const Progress& progress) {
  return or_bad_input(config, [&] { return merged(config, recordings, reference, {}, progress); });
}

}  // namespace coast::jobs
