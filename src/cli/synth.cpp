#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <mutex>

#include "coast/array/extended.hpp"
#include "coast/array/resample.hpp"
#include "coast/io/member_blocks.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/record/error.hpp"
#include "coast/report/render.hpp"
#include "commands.hpp"
#include "load.hpp"
#include "progress.hpp"
#include "synth_page.hpp"

namespace coast::cli {

namespace {

record::ImuRecording read_tagged(const ArrayConfig& config, std::size_t k, std::optional<geo::GpsTime> near) {
  const ArrayImu& imu = config.imus[k];
  return io::read_imu(std::get<io::ImuFileOptions>(imu.file), near);
}

/// Clocks first, then every device's samples by them.
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

std::vector<record::ImuRecording> read_imus(const ArrayConfig& config, SynthResult& result, ProgressLine& line) {
  std::vector<record::ImuRecording> recordings;
  if (config.time == TimeSource::kTags) {
    for (std::size_t k = 0; k < config.imus.size(); ++k) {
      line.show("reading", static_cast<double>(k) / static_cast<double>(config.imus.size()));
      recordings.push_back(read_tagged(config, k, k == 0 ? std::nullopt : std::optional(recordings.front().samples.front().t)));
    }
  } else {
    line.show("reading", 0.0);
    recordings = read_packet_imus(config, result);
  }
  for (const record::ImuRecording& recording : recordings) {
    result.sources.push_back(recording.source);
    result.events.insert(result.events.end(), recording.events.begin(), recording.events.end());
  }
  return recordings;
}

/// True values on the grid of the array.
std::optional<array::SensorSignals> read_reference(const ArrayConfig& config, const array::Signals& signals) {
  if (!config.reference) return {};
  const record::ImuRecording recording = io::read_imu(*config.reference, signals.start);
  return array::resample(recording, {signals.start, signals.dt, signals.samples()});
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

std::string synthetic_name(const ArrayConfig& config) {
  return fmt::format("synthetic IMU of {}, {}", config.imus.size(), merge_name(config.merge.merge));
}

std::vector<array::ModelledSensor> modelled_sensors(const ArrayConfig& config, const array::Assembly& assembly) {
  std::vector<array::ModelledSensor> sensors;
  for (std::size_t k = 0; k < config.imus.size(); ++k)
    sensors.push_back({config.imus[k].name, &*config.imus[k].model,
                       assembly.mounting ? assembly.mounting->sensors[k].frame.C_s_b : config.imus[k].frame.C_s_b});
  return sensors;
}

void merge_all(const ArrayConfig& config, SynthResult& result, ProgressLine& line) {
  constexpr double kAverage = 1.0;  // s: slow errors are told from means over this
  const array::Assembly& assembly = result.assembly;
  const std::optional<array::SensorSignals> reference = read_reference(config, assembly.signals);
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
  tbb::parallel_for(0, array::kChannels, [&](int c) {
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
    line.show("merging", done);
  });
}

void write_results(const ArrayConfig& config, const SynthResult& result, const std::filesystem::path& out) {
  const report::Page page = synth_page(config, result);
  io::begin_results(out / "synth.json");
  io::write_imu_csv(out / "imu.csv", synthetic_imu(result));
  io::write_text(out / "noise.csv", noise_csv(result));
  io::write_text(out / "error_model.yaml",
                 result.extended
                     ? result.extended->yaml()
                     : array::error_model_yaml(synthetic_name(config), 1.0 / result.assembly.signals.dt, result.remaining));
  if (result.extended) io::write_member_blocks(out / "members.csv", array::member_blocks(result.assembly.signals));
  io::write_text(out / "array.resolved.yaml", config.root.resolved_yaml());
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  io::write_text(out / "synth.json", synth_json(config, result));
}

std::vector<std::string> files_of(const ArrayConfig& config) {
  std::vector<std::string> files{"imu.csv",     "noise.csv",  "error_model.yaml", "synth.json", "array.resolved.yaml",
                                 "report.json", "report.html"};
  if (config.merge.merge == array::Merge::kExtended) files.emplace_back("members.csv");
  return files;
}

}  // namespace

void synth(const std::filesystem::path& array_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const ArrayConfig config = read_array_config(array_yaml);
  for (const ArrayImu& imu : config.imus)  // those of an earlier job of coast's, too, are refused before they are read
    std::visit([](const auto& recording) { io::note_read(recording.file); }, imu.file);
  const std::filesystem::path out = output_folder(array_yaml, options.out, files_of(config));
  SynthResult result;
  try {
    const std::vector<record::ImuRecording> recordings = read_imus(config, result, line);
    std::vector<array::ArrayMember> members;
    for (std::size_t k = 0; k < recordings.size(); ++k)
      members.push_back({config.imus[k].name, &recordings[k], config.imus[k].frame});
    result.assembly =
        array::assemble(members, config.assembly, [&](const char* what, double share) { line.show(what, share); });
    result.events.insert(result.events.end(), result.assembly.events.begin(), result.assembly.events.end());
    merge_all(config, result, line);
  } catch (const std::invalid_argument& error) {  // recordings that are too short, or have no time in common
    throw config.root.error(error.what(), "recordings that can be merged", "Are the files those of one mission?");
  }
  line.show("writing", 0.0);
  write_results(config, result, out);
  line.clear();
  for (const record::Event& event : result.events)
    if (event.severity == record::Event::Severity::kWarning) fmt::print(stderr, "warning: {}\n", event.text);
  if (options.quiet) return;
  for (const std::string& sentence : synth_sentences(config, result)) fmt::print("{}\n", sentence);
  const geo::GpsTime start = result.assembly.signals.start;
  const std::string over_time = result.extended ? fmt::format("members: {}", (out / "members.csv").string())
                                                : fmt::format("noise_levels: {}", (out / "noise.csv").string());
  fmt::print("in run.yaml: imu: {{file: {}, gps_week: {}, error_model: {}, {}}}\n", (out / "imu.csv").string(), start.week(),
             (out / "error_model.yaml").string(), over_time);
}

}  // namespace coast::cli
