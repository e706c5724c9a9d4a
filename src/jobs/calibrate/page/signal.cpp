// The record compared with the estimate: realisations, smoothed components.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/page/parts.hpp"
#include "calibrate/units.hpp"
#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

namespace {

constexpr std::size_t kPoints = 400;  // for a curve of means
constexpr std::uint64_t kRealisations = 20;
constexpr std::size_t kShort = 300;  // samples of the view at full rate

/// Level subtracted, and the slope if the model has a drift: realisations are without them and treated in the same way.
noise::StaticSignal centred(const noise::StaticSignal& signal, noise::Mean mean) {
  if (mean == noise::Mean::kLevelAndDrift) return noise::detrend(signal).signal;
  noise::StaticSignal result = signal;
  const double level = noise::detrend(signal).level;
  for (double& value : result.values) value -= level;
  return result;
}

/// Appends a signal as a curve over seconds; interrupted at its holes.
void append(const noise::StaticSignal& signal, const char* unit, report::Series& series) {
  for (const noise::StaticSignal::Run& run : signal.runs) {
    if (!series.x.empty()) series.breaks.push_back(static_cast<std::uint32_t>(series.x.size()));
    for (std::size_t i = 0; i < run.count; ++i) {
      series.x.push_back((static_cast<double>(run.start + i) + 0.5) * signal.interval);
      series.y.push_back(in_unit(signal.values[run.first + i], unit));
    }
  }
}

std::uint64_t seed_of(const CalibratedAxis& axis, std::uint64_t seed, std::uint64_t draw) {
  const auto place = static_cast<std::uint64_t>(axis.axis.axis) + (axis.axis.sensor == noise::Sensor::kGyro ? 0U : 3U);
  return seed + 7919U * (draw + 1U) + 104729U * place;
}

report::Panel short_panel(const CalibratedAxis& axis, const noise::StaticSignal& drawn, const char* unit) {
  const noise::Mean mean = axis.result.best().model.mean();
  report::Panel panel = report::stacked_time_panel(id_of(axis) + "-samples", "First samples", {"record", "realisation"}, unit,
                                                   "At full rate. Good: record and realisation cannot be distinguished.");
  const noise::StaticSignal& record = axis.signals.front();
  const std::size_t count = std::min({kShort, record.runs.front().count, drawn.values.size()});
  double reach = 0.0;
  const auto add = [&](report::Plot& plot, const noise::StaticSignal& signal, report::Tone tone) {
    report::Series series;
    append(noise::part_of(centred(signal, mean), 0, count), unit, series);
    for (const double y : series.y) reach = std::max(reach, std::abs(y));
    report::add_line(plot, plot.y.label, std::move(series), tone);
  };
  add(panel.plots[0], record, tone_of(axis));
  add(panel.plots[1], drawn, report::Tone::kReference);
  for (report::Plot& plot : panel.plots) {
    if (reach > 0.0) plot.y.range.emplace(-1.1 * reach, 1.1 * reach);
    plot.link = panel.id;
  }
  return panel;
}

}  // namespace

void add_restitution(const CalibratedAxis& axis, std::uint64_t seed, report::Section& section) {
  const noise::Candidate& best = axis.result.best();
  const noise::StaticSignal& record = axis.signals.front();
  const char* unit = sheet_units(axis.axis.sensor).signal;
  const auto factor = static_cast<std::size_t>(std::max<std::uint64_t>(1, record.length() / kPoints));
  const auto means = [&](const noise::StaticSignal& signal) {
    return noise::block_means(centred(signal, best.model.mean()), factor);
  };
  report::Series many;
  noise::StaticSignal last;
  for (std::uint64_t draw = 0; draw < kRealisations; ++draw) {
    last = noise::realisation(best.model, best.fit.u, record.interval, record.length(), seed_of(axis, seed, draw));
    append(means(last), unit, many);
  }
  report::Panel panel = report::time_panel(
      id_of(axis) + "-restitution", "Restitution", unit,
      fmt::format("Means over {}: the record among {} realisations of the estimate. Good: it lies within their "
                  "spread.",
                  duration_text(static_cast<double>(factor) * record.interval), kRealisations));
  report::add_line(panel.plot(), "realisations", std::move(many), report::Tone::kFaint).width_px = 0.8;
  report::Series own;
  append(means(record), unit, own);
  report::add_line(panel.plot(), "record", std::move(own), tone_of(axis)).width_px = 1.8;
  panel.plot().height_px = 280;
  section.panels.push_back(std::move(panel));
  section.panels.push_back(short_panel(axis, last, unit));
}

std::optional<report::Panel> components_panel(const CalibratedAxis& axis) {
  const noise::Candidate& best = axis.result.best();
  if (best.model.states() == 0) return {};
  const noise::Likelihood likelihood({axis.signals.front()}, best.model);
  const noise::SmoothedComponents smoothed = noise::smoothed_components(likelihood, best.fit.u, 0, kPoints);
  if (smoothed.components.empty()) return {};
  const char* unit = sheet_units(axis.axis.sensor).signal;
  const auto scaled = [&](std::vector<double> values) {
    for (double& value : values) value = in_unit(value, unit);
    return values;
  };
  std::vector<std::string> names{"sum"};
  for (std::size_t t = 0; t < best.model.terms().size(); ++t)
    if (best.model.terms()[t].states > 0) names.push_back(term_name(best.model, t));
  report::Panel panel = report::stacked_time_panel(
      id_of(axis) + "-components", "Processes in the record", names, unit,
      "What the smoother says each process was, with 95 % bands, and the sum over the record's means. A process that stays "
      "inside its band around zero is not seen one by one, only in the statistics.");
  std::vector<double> sum(smoothed.time_s.size(), 0.0);
  for (std::size_t i = 0; i < smoothed.components.size(); ++i) {
    const auto& component = smoothed.components[i];
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += component.value[k];
    report::Line& line =
        report::add_line(panel.plots[i + 1], names[i + 1],
                         curve(smoothed.time_s, scaled(component.value), scaled(component.sd), 1.96), report::Tone::kSmoothed);
    line.band_label = "95 %";
  }
  report::add_line(panel.plots[0], "record, means", curve(smoothed.time_s, scaled(smoothed.signal)), report::Tone::kMuted);
  report::add_line(panel.plots[0], "sum of processes", curve(smoothed.time_s, scaled(sum)), report::Tone::kSmoothed).width_px =
      1.8;
  return panel;
}

}  // namespace coast::jobs
