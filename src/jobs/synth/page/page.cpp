#include "synth/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/page_parts.hpp"
#include "synth/config.hpp"
#include "synth/page/parts.hpp"

namespace coast::jobs {

namespace {

/// Ratio of merged noise to the best single sensor's, mean over three channels.
double gain(const SynthResult& result, int first) {
  double sum = 0.0;
  for (int c = first; c < first + 3; ++c) {
    const array::MergedChannel& channel = result.channels[static_cast<std::size_t>(c)];
    const std::vector<double> own = own_sds(channel);
    sum += merged_sd(channel) / *std::ranges::min_element(own) / 3.0;
  }
  return sum;
}

report::Tile gain_tile(const SynthResult& result, int first, const char* label) {
  report::Tile tile;
  tile.label = label;
  tile.value = number(gain(result, first));
  tile.verdict = gain(result, first) < 1.0 ? report::Verdict::kGood : report::Verdict::kWarn;
  tile.explanation = fmt::format(
      "Noise of the synthetic IMU over that of the best single one, mean of the three axes. {} like sensors with independent "
      "noise "
      "give {}.",
      result.sources.size(), number(1.0 / std::sqrt(static_cast<double>(result.sources.size()))));
  tile.section = "noise";
  return tile;
}

report::Tile lag_tile(const SynthResult& result) {
  double largest = 0.0;
  for (const auto& lag : result.assembly.lags)
    if (lag) largest = std::max(largest, std::abs(lag->offset_s));
  report::Tile tile;
  tile.label = "Largest lag";
  tile.value = result.assembly.lags.empty() ? "not asked for" : decimals(1e3 * largest, 2);
  tile.unit = result.assembly.lags.empty() ? "" : "ms";
  tile.explanation = "Of a sensor's time tags against the first one's, by the signals; taken out before merging.";
  tile.section = "time";
  return tile;
}

report::Tile defect_tile(const SynthResult& result) {
  double left_out = 0.0;
  for (const array::Defect& defect : result.assembly.defects.defects)
    left_out += static_cast<double>(defect.to - defect.from) * result.assembly.signals.dt;
  report::Tile tile;
  tile.label = "Defects";
  tile.value = fmt::format("{}", result.assembly.defects.defects.size());
  tile.verdict = result.assembly.defects.defects.empty() ? report::Verdict::kGood : report::Verdict::kWarn;
  tile.explanation =
      fmt::format("Stretches in which a sensor contradicts the others; left out for {} s in all.", decimals(left_out, 1));
  tile.section = "defects";
  return tile;
}

}  // namespace

report::Page synth_page(const ArrayConfig& config, const SynthResult& result) {
  report::Page page;
  page.title = fmt::format("Synthetic IMU of {}", result.sources.size());
  page.subtitle = fmt::format("{}: {}", config.file.filename().string(), merge_name(config.merge.merge));
  page.start = result.assembly.signals.start;
  page.tiles = {gain_tile(result, 0, "Gyro noise"), gain_tile(result, 3, "Accelerometer noise"), lag_tile(result),
                defect_tile(result)};
  page.sections = {array_noise_section(config, result), array_time_section(config, result),
                   array_mounting_section(config, result), array_defect_section(config, result)};
  report::Section log{"log", "What was done", joined(synth_sentences(config, result), " "), {}, {}, {}};
  if (!result.events.empty()) log.tables.push_back(event_table(result.events));
  log.notes.push_back({report::Note::Kind::kCode, "Configuration as resolved", config.root.resolved_yaml()});
  page.sections.push_back(std::move(log));
  page.footer = fmt::format("coast {}, coast synth", COAST_VERSION);
  return page;
}

}  // namespace coast::jobs
