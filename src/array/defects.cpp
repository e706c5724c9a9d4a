#include "coast/array/defects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "coast/parallel.hpp"
#include "defect_biases.hpp"
#include "defect_kind.hpp"
#include "defect_watch.hpp"
#include "parity_outages.hpp"
#include "parity_response.hpp"

namespace coast::array {

namespace {

void check_input(const Signals& signals, const DefectOptions& options) {
  constexpr double kShortest = 20.0;  // s
  if (signals.sensors.size() < 2)
    throw std::invalid_argument(fmt::format("find_defects: {} sensors, at least 2 needed", signals.sensors.size()));
  if (!(signals.dt > 0.0 && signals.dt <= 1.0)) throw std::invalid_argument(fmt::format("find_defects: dt {} s", signals.dt));
  if (static_cast<double>(signals.samples()) * signals.dt < kShortest)
    throw std::invalid_argument(
        fmt::format("find_defects: {} samples of {} s, at least {} s needed", signals.samples(), signals.dt, kShortest));
  for (const SensorSignals& sensor : signals.sensors)
    if (sensor.usable.size() != signals.samples() || sensor.values.cols() != static_cast<Eigen::Index>(signals.samples()))
      throw std::invalid_argument(fmt::format("find_defects: {} has another number of columns", sensor.name));
  if (!(options.false_alarms_per_hour > 0.0 && options.recovery_s > 0.0 && options.noise_memory_s > 0.0))
    throw std::invalid_argument("find_defects: an option is not above zero");
}

/// Results for one channel.
struct ChannelResult {
  std::vector<Alarm> alarms;
  std::vector<Disagreement> disagreements;
  std::vector<std::pair<double, double>> noise;  ///< [sensor] median variances: sample, block
};

ChannelResult watch_channel(const Signals& signals, const ParityBlocks& blocks, const SensorSpread& spread, int channel,
                            double share, const DefectOptions& options) {
  const ChannelNoise noise(signals, blocks, channel, options.noise_memory_s);
  ChannelWindows windows(signals, blocks, noise, spread, channel, share);
  const auto recovery = static_cast<std::size_t>(std::max(1.0, std::round(options.recovery_s / blocks.seconds)));
  DefectWatch watch(windows, blocks.count, channel, recovery);
  watch.run();
  ChannelResult result{watch.alarms(), watch.disagreements(), {}};
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
    std::vector<double> sample, block;
    for (std::size_t b = 0; b < blocks.count; b += 10) {
      sample.push_back(noise.sample_variance(k, b));
      block.push_back(noise.block_variance(k, b));
    }
    result.noise.emplace_back(median_of(sample), median_of(block));
  }
  return result;
}

/// In columns. The last block of a record extends to its end.
Defect in_columns(const Alarm& alarm, const ParityBlocks& blocks, std::size_t samples) {
  Defect defect;
  defect.sensor = alarm.sensor;
  defect.channels = static_cast<std::uint8_t>(1U << alarm.channel);
  defect.from = alarm.onset * blocks.length;
  defect.to = alarm.back >= blocks.count ? samples : alarm.back * blocks.length;
  defect.found = (alarm.found + 1) * blocks.length - 1;
  defect.statistic = alarm.statistic;
  return defect;
}

/// Joins defects of one sensor that overlap (or touch) and were detected within `apart` columns; of outages only those of one
/// kind.
std::vector<Defect> joined(std::vector<Defect> defects, std::size_t apart, bool same_kind) {
  std::sort(defects.begin(), defects.end(), [](const Defect& a, const Defect& b) {
    return std::tie(a.sensor, a.from, a.channels) < std::tie(b.sensor, b.from, b.channels);
  });
  std::vector<Defect> result;
  for (const Defect& next : defects) {
    const auto same = std::find_if(result.rbegin(), result.rend(), [&](const Defect& d) {
      const std::size_t between = d.found > next.found ? d.found - next.found : next.found - d.found;
      return d.sensor == next.sensor && d.to >= next.from && between <= apart && (!same_kind || d.kind == next.kind);
    });
    if (same == result.rend()) {
      result.push_back(next);
      continue;
    }
    if (next.found < same->found) same->statistic = next.statistic;
    same->channels = static_cast<std::uint8_t>(same->channels | next.channels);
    same->from = std::min(same->from, next.from);
    same->to = std::max(same->to, next.to);
    same->found = std::min(same->found, next.found);
  }
  return result;
}

DefectThresholds thresholds_of(double share, double block_s) {
  DefectThresholds thresholds;
  thresholds.per_test_per_hour = share;
  for (const std::size_t w : kLevelWindows)
    thresholds.level.emplace_back(static_cast<double>(w) * block_s, normal_threshold(share, block_s, w, true));
  for (const std::size_t w : kNoiseWindows)
    thresholds.noise.emplace_back(static_cast<double>(w) * block_s, normal_threshold(share, block_s, w, false));
  for (const std::size_t w : kMotionWindows)
    thresholds.motion.emplace_back(static_cast<double>(w) * block_s, std::sqrt(chi2_threshold(3.0, share, block_s, w)));
  return thresholds;
}

}  // namespace

std::string_view name_of(DefectKind kind) {
  constexpr std::array<std::string_view, kDefectKinds> kNames{"bias_jump", "scale_change", "stuck",  "noise_burst",
                                                              "dropout",   "swapped_axis", "unknown"};
  return kNames.at(static_cast<std::size_t>(kind));
}

DefectReport find_defects(const Signals& signals, const DefectOptions& options) {
  check_input(signals, options);
  const std::size_t sensors = signals.sensors.size(), samples = signals.samples();
  const double share = options.false_alarms_per_hour / (kTestsPerChannel * kChannels * static_cast<double>(sensors));
  const Outages outages = find_outages(signals, share);
  const Signals compared = without_constant_response(signals, outages.present, make_blocks(signals, outages.present));
  const ParityBlocks blocks = make_blocks(compared, outages.present);

  const SensorSpread spread = sensor_spread(compared, blocks);

  std::array<ChannelResult, kChannels> channels;
  coast::parallel_for(0, kChannels, [&](int c) {
    channels.at(static_cast<std::size_t>(c)) = watch_channel(compared, blocks, spread, c, share, options);
  });

  DefectReport report;
  report.block_s = blocks.seconds;
  report.thresholds = thresholds_of(share, blocks.seconds);
  report.noise.resize(sensors);
  std::vector<Channels> variance(sensors);
  std::vector<Defect> found;
  for (int c = 0; c < kChannels; ++c) {
    const ChannelResult& of_channel = channels.at(static_cast<std::size_t>(c));
    for (const Alarm& alarm : of_channel.alarms) found.push_back(in_columns(alarm, blocks, samples));
    for (Disagreement record : of_channel.disagreements) {
      record.found = (record.found + 1) * blocks.length - 1;
      report.disagreements.push_back(record);
    }
    for (std::size_t k = 0; k < sensors; ++k) {
      variance[k](c) = of_channel.noise[k].first;
      report.noise[k].sample_sd(c) = std::sqrt(of_channel.noise[k].first);
      report.noise[k].block_sd(c) = std::sqrt(of_channel.noise[k].second);
    }
  }
  const auto recovery = static_cast<std::size_t>(options.recovery_s / signals.dt);
  report.defects = joined(found, recovery, false);
  for (Defect& defect : report.defects) name_defect(compared, outages.present, blocks, variance, recovery, defect);
  const std::vector<Defect> gone = joined(outages.defects, blocks.length, true);
  report.defects.insert(report.defects.end(), gone.begin(), gone.end());
  std::stable_sort(report.defects.begin(), report.defects.end(),
                   [](const Defect& a, const Defect& b) { return a.from < b.from; });
  report.biases = piecewise_biases(blocks, report.defects, samples);
  return report;
}

void exclude(Signals& signals, const DefectReport& report) {
  for (const Defect& defect : report.defects) {
    if (defect.sensor >= signals.sensors.size() || defect.to > signals.samples())
      throw std::invalid_argument(fmt::format("exclude: sensor {}, columns to {} of {} x {}", defect.sensor, defect.to,
                                              signals.sensors.size(), signals.samples()));
    auto& usable = signals.sensors[defect.sensor].usable;
    for (std::size_t n = defect.from; n < defect.to; ++n) usable[n] = static_cast<std::uint8_t>(usable[n] & ~defect.channels);
  }
}

}  // namespace coast::array
