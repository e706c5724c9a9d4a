#include "calibrate/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/page/parts.hpp"
#include "calibrate/units.hpp"
#include "coast/parallel.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

namespace {

using noise::Sensor;
using report::Verdict;

std::string lower_name(Sensor sensor) {
  return sensor == Sensor::kGyro ? "gyro" : "accelerometer";
}

/// One tile of three values, x / y / z.
report::Tile axis_tile(const CalibrationResult& result, Sensor sensor, std::string label, const char* unit,
                       const std::function<std::string(const CalibratedAxis&)>& text) {
  report::Tile tile;
  tile.label = std::move(label);
  std::vector<std::string> values;
  for (const CalibratedAxis* axis : result.of(sensor)) values.push_back(text(*axis));
  tile.value = joined(values, " / ");
  tile.unit = unit;
  tile.section = lower_name(sensor);
  return tile;
}

std::string white_noise_of(const CalibratedAxis& axis) {
  const char* unit = sheet_units(axis.axis.sensor).white_noise;
  if (const auto& reading = axis.result.reading.white_noise) return number(in_unit(reading->value, unit));
  return "none read";
}

std::string bias_instability_of(const CalibratedAxis& axis) {
  const char* unit = sheet_units(axis.axis.sensor).signal;
  if (const auto& reading = axis.result.reading.bias_instability) return number(in_unit(reading->value, unit));
  const noise::AllanCurve& curve = axis.result.curves.front();
  const auto lowest = std::ranges::min_element(curve, {}, [](const noise::AllanPoint& p) { return p.allan.value; });
  return "< " + number(in_unit(lowest->allan.value / 0.664, unit));
}

// "WN + 2 GM", without the mean that every model has.
std::string short_name(const CalibratedAxis& axis) {
  std::string name = axis.result.best().model.name();
  if (const auto at = name.find(" + level"); at != std::string::npos) name.erase(at, 8);
  return name;
}

report::Tile model_tile(const CalibrationResult& result, Sensor sensor) {
  report::Tile tile =
      axis_tile(result, sensor, fmt::format("{} model", sensor == Sensor::kGyro ? "Gyro" : "Accelerometer"), "", short_name);
  const auto axes = result.of(sensor);
  if (std::ranges::all_of(axes, [&](const auto* a) { return short_name(*a) == short_name(*axes.front()); }))
    tile.value = short_name(*axes.front());
  tile.explanation =
      "The sum of processes that the criterion chose, axis by axis: WN white noise, GM Gauss-Markov, RW random walk, AR noise "
      "that the sensor filtered, QN rounding, DR drift.";
  return tile;
}

std::optional<report::Tile> band_tile(const CalibrationResult& result, Sensor sensor) {
  std::size_t judged = 0;
  std::size_t inside = 0;
  for (const CalibratedAxis* axis : result.of(sensor)) {
    if (axis->result.band.tau.empty()) continue;
    ++judged;
    if (axis->result.band.inside) ++inside;
  }
  if (judged == 0) return {};
  report::Tile tile;
  tile.label = fmt::format("Allan curve in band, {}", lower_name(sensor));
  tile.value = fmt::format("{} of {}", inside, judged);
  tile.unit = "axes";
  tile.verdict = inside == judged ? Verdict::kGood : inside > 0 ? Verdict::kWarn : Verdict::kBad;
  tile.explanation =
      "Axes whose curve lies inside the simultaneous 95 % band of realisations of the estimate at every averaging time: the "
      "model says what the record does.";
  tile.section = lower_name(sensor);
  return tile;
}

void add_tiles(const CalibrationResult& result, Sensor sensor, report::Page& page) {
  if (result.of(sensor).empty()) return;
  const SheetUnits& units = sheet_units(sensor);
  const char* name = sensor == Sensor::kGyro ? "Gyro" : "Accelerometer";
  page.tiles.push_back(axis_tile(result, sensor, fmt::format("{} white noise", name), units.white_noise, white_noise_of));
  page.tiles.back().explanation =
      sensor == Sensor::kGyro
          ? "Angle random walk, as it is read from the stretch of the Allan curve with slope -1/2; x, y, z."
          : "Velocity random walk, as it is read from the stretch of the Allan curve with slope -1/2; x, y, z.";
  page.tiles.push_back(axis_tile(result, sensor, fmt::format("{} bias instability", name), units.signal, bias_instability_of));
  // If no axis has a floor, one message is enough.
  const auto shown = [](const CalibratedAxis* axis) { return axis->result.reading.bias_instability.has_value(); };
  if (std::ranges::none_of(result.of(sensor), shown)) {
    std::string& value = page.tiles.back().value;
    for (auto at = value.find("< "); at != std::string::npos; at = value.find("< ")) value.erase(at, 2);
    page.tiles.back().label += ", below";
  }
  page.tiles.back().explanation =
      "Lowest point of the Allan curve over 0.664; where the curve still falls at its end, or has another slope, it is below.";
  page.tiles.push_back(model_tile(result, sensor));
  if (auto tile = band_tile(result, sensor)) page.tiles.push_back(std::move(*tile));
}

report::Section records_section(const CalibrationConfig& config, const CalibrationResult& result) {
  report::Section section;
  section.id = "records";
  section.title = "Records";
  section.lead = fmt::format("{} static recording{} of {} at {:.6g} Hz, in the axes of the sensor.", result.records.size(),
                             result.records.size() == 1 ? "" : "s", config.sensor, 1.0 / result.interval);
  report::Table table;
  table.id = "records-table";
  table.title = "What was read";
  table.columns = {{"record", "", false}, {"samples", ""}, {"span", "", false}, {"holes", ""}, {"use", "", false}};
  const auto add = [&](const ReadRecord& r, const char* use) {
    const std::string name = std::filesystem::path(r.source).filename().string();
    table.rows.push_back(
        cells({name, fmt::format("{}", r.samples), duration_text(r.duration), fmt::format("{}", r.holes), use}));
    for (const std::string& remark : r.remarks) section.notes.push_back({report::Note::Kind::kWarning, name, remark});
  };
  for (const ReadRecord& r : result.records) add(r, "estimate");
  for (const ReadRecord& r : result.tested_on) add(r, "test");
  for (const record::Event& event : result.events)
    section.notes.push_back(
        {event.severity == record::Event::Severity::kWarning ? report::Note::Kind::kWarning : report::Note::Kind::kInfo, "",
         event.text});
  section.tables.push_back(std::move(table));
  section.notes.push_back({report::Note::Kind::kCode, "error_model.yaml", error_model_yaml(config, result)});
  return section;
}

}  // namespace

report::Page calibration_page(const CalibrationConfig& config, const CalibrationResult& result) {
  report::Page page;
  page.title = fmt::format("Calibration of {}", config.sensor);
  double longest = 0.0;
  for (const ReadRecord& record : result.records) longest = std::max(longest, record.duration);
  page.subtitle = fmt::format("Static records: {} of up to {} at {:.6g} Hz; maximum likelihood", result.records.size(),
                              duration_text(longest), 1.0 / result.interval);
  for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel}) add_tiles(result, sensor, page);
  page.sections.push_back(records_section(config, result));
  std::vector<report::Section> axes(result.axes.size());
  coast::parallel_for(std::size_t{0}, axes.size(), [&](std::size_t i) { axes[i] = axis_section(config, result.axes[i]); });
  for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel}) {
    if (result.of(sensor).empty()) continue;
    page.sections.push_back(sensor_section(result, sensor));
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (result.axes[i].axis.sensor == sensor) page.sections.push_back(std::move(axes[i]));
  }
  page.footer = fmt::format("coast {}: calibrate {}", COAST_VERSION, config.file.filename().string());
  return page;
}

}  // namespace coast::jobs
