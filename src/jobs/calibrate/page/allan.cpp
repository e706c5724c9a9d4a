// Allan curves of the calibration page.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calibrate/page/parts.hpp"
#include "calibrate/units.hpp"
#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

namespace {

constexpr int kAllanHeight = 420;

report::Axis log_axis(std::string label, std::string unit) {
  return {std::move(label), std::move(unit), report::Axis::Scale::kLog, {}, {}};
}

template <class Deviation>
report::Series model_series(const noise::AllanCurve& curve, const char* unit, const Deviation& deviation) {
  constexpr int kPoints = 160;
  report::Series series;
  const double first = curve.front().tau;
  const double ratio = curve.back().tau / first;
  for (int i = 0; i <= kPoints; ++i) {
    const double tau = first * std::pow(ratio, static_cast<double>(i) / kPoints);
    const double value = deviation(tau);
    if (!(value > 0.0)) continue;
    series.x.push_back(tau);
    series.y.push_back(in_unit(value, unit));
  }
  return series;
}

void add_model(const CalibratedAxis& axis, const char* unit, report::Plot& plot) {
  const noise::Candidate& best = axis.result.best();
  const noise::AllanCurve& curve = axis.result.curves.front();
  const auto processes = best.model.processes(best.fit.u, {axis.axis.sensor, axis.signals.front().interval});
  const bool drifts = best.model.mean() == noise::Mean::kLevelAndDrift && !axis.result.means.empty();
  const double slope = drifts ? axis.result.means.front().value(1) : 0.0;
  // IEEE Std 952-1997 annex C: a ramp R t has the deviation R tau / sqrt(2).
  const auto ramp = [slope](double tau) { return std::abs(slope) * tau / std::sqrt(2.0); };
  const auto whole = [&](double tau) { return std::hypot(std::sqrt(noise::allan_variance(processes, tau)), ramp(tau)); };
  report::add_line(plot, "model", model_series(curve, unit, whole), report::Tone::kReference).width_px = 2.0;
  const auto part = [&](const std::string& label, const auto& deviation) {
    report::Line& line = report::add_line(plot, label, model_series(curve, unit, deviation));
    line.style = report::Line::Style::kDashed;
  };
  if (processes.size() > 1)
    for (std::size_t i = 0; i < processes.size(); ++i)
      part(term_name(best.model, i), [&](double tau) { return std::sqrt(processes[i]->allan_variance(tau).value_or(0.0)); });
  if (drifts) part("drift", ramp);
}

/// A correlation time below two intervals: samples are instantaneous values, the curve is of means.
bool faster_than_samples(const CalibratedAxis& axis) {
  const noise::Candidate& best = axis.result.best();
  for (std::size_t i = 0; i < best.fit.u.size(); ++i) {
    const noise::ParameterInfo info = best.model.parameter(i);
    if (info.kind == noise::ParameterInfo::Kind::kRate && info.value(best.fit.u[i]) * axis.signals.front().interval > 0.5)
      return true;
  }
  return false;
}

report::Table classical_table(const CalibrationResult& result, noise::Sensor sensor) {
  const SheetUnits& units = sheet_units(sensor);
  report::Table table;
  table.id = sensor == noise::Sensor::kGyro ? "gyro-classical" : "accel-classical";
  table.title = "Classical coefficients";
  table.caption =
      "Read from the slopes of the curves as in IEEE Std 952, with 95 % intervals; left out where the curve has no such "
      "stretch. "
      "A reading gives all of the curve to one process.";
  table.columns = {{"axis", "", false}, {"coefficient", "", false}, {"value", ""}, {"unit", "", false}, {"95 % from", ""},
                   {"to", ""},          {"read at", "", false}};
  for (const CalibratedAxis* axis : result.of(sensor)) {
    const auto add = [&](const char* name, const std::optional<noise::CoefficientReading>& c, const char* unit) {
      if (!c) return;
      table.rows.push_back(
          cells({axis->axis.axis_name(), name, figure(in_unit(c->value, unit)), unit,
                 figure(in_unit(c->interval_95.lower, unit)), figure(in_unit(c->interval_95.upper, unit)),
                 c->tau_to > c->tau_from ? fmt::format("{} to {}", duration_text(c->tau_from), duration_text(c->tau_to))
                                         : duration_text(c->tau_from)}));
    };
    const noise::AllanReading& reading = axis->result.reading;
    add("quantisation Q", reading.quantisation, units.integral);
    add("white noise N", reading.white_noise, units.white_noise);
    add("bias instability B", reading.bias_instability, units.signal);
    add("rate random walk K", reading.rate_random_walk, units.rate_random_walk);
    add("rate ramp R", reading.rate_ramp, units.rate_ramp);
  }
  return table;
}

}  // namespace

report::Series allan_series(const noise::AllanCurve& curve, const char* unit, bool band) {
  report::Series series;
  if (band) series.band.emplace();
  for (const noise::AllanPoint& point : curve) {
    if (!(point.allan.value > 0.0)) continue;
    series.x.push_back(point.tau);
    series.y.push_back(in_unit(point.allan.value, unit));
    if (!band) continue;
    series.band->x.push_back(point.tau);
    series.band->lower.push_back(in_unit(point.allan.interval_95.lower, unit));
    series.band->upper.push_back(in_unit(point.allan.interval_95.upper, unit));
  }
  return series;
}

report::Series band_series(const noise::CurveBand& band, const char* unit) {
  report::Series series;
  series.x = series.band.emplace().x = band.tau;
  for (std::size_t i = 0; i < band.tau.size(); ++i) {
    series.y.push_back(in_unit(band.median[i], unit));
    series.band->lower.push_back(in_unit(band.lower[i], unit));
    series.band->upper.push_back(in_unit(band.upper[i], unit));
  }
  return series;
}

report::Plot allan_plot(const std::vector<const noise::AllanCurve*>& curves, const char* unit) {
  report::Plot plot;
  plot.x = log_axis("averaging time", "s");
  plot.y = log_axis("Allan deviation", unit);
  plot.height_px = kAllanHeight;
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0.0;
  for (const noise::AllanCurve* curve : curves)
    for (const noise::AllanPoint& point : *curve) {
      if (!(point.allan.value > 0.0)) continue;
      least = std::min(least, point.allan.value);
      greatest = std::max(greatest, point.allan.value);
    }
  if (greatest > 0.0) plot.y.range.emplace(in_unit(least, unit) / 3.0, in_unit(greatest, unit) * 2.0);
  return plot;
}

report::Panel allan_panel(const CalibratedAxis& axis) {
  const char* unit = sheet_units(axis.axis.sensor).signal;
  const noise::AxisCalibration& r = axis.result;
  report::Panel panel;
  panel.id = id_of(axis) + "-allan";
  panel.title = "Allan deviation";
  panel.caption =
      "The record with its 95 % intervals, the fitted sum and each of its processes. Good: the record stays inside the grey "
      "band, which 95 of 100 realisations of the estimate do not leave anywhere.";
  if (faster_than_samples(axis))
    panel.caption +=
        " A process is faster than the samples: the model's curve, of continuous time, and the median of the realisations part "
        "at short averaging times.";
  std::vector<const noise::AllanCurve*> curves;
  for (const noise::AllanCurve& curve : r.curves) curves.push_back(&curve);
  report::Plot& plot = panel.plots.emplace_back(allan_plot(curves, unit));
  if (!r.band.tau.empty()) {
    report::Line& line = report::add_line(plot, "realisations, median", band_series(r.band, unit), report::Tone::kMuted);
    line.band_label = "95 % of all curves";
    line.width_px = 1.0;
  }
  add_model(axis, unit, plot);
  const bool several = r.curves.size() > 1;
  // Different from the colours of the first record and the processes.
  constexpr std::array kOthers{report::Tone::kForward, report::Tone::kSmoothed, report::Tone::kSbas, report::Tone::kSingle,
                               report::Tone::kPpp};
  for (std::size_t i = 0; i < r.curves.size(); ++i) {
    report::Line& line =
        report::add_line(plot, several ? record_name(axis.signals[i].source) : "record",
                         allan_series(r.curves[i], unit, i == 0), i == 0 ? tone_of(axis) : kOthers[(i - 1) % kOthers.size()]);
    if (i == 0) line.band_label = "95 %";
    line.width_px = i == 0 ? 1.8 : 1.2;
  }
  return panel;
}

report::Section sensor_section(const CalibrationResult& result, noise::Sensor sensor) {
  const bool gyro = sensor == noise::Sensor::kGyro;
  const char* unit = sheet_units(sensor).signal;
  const auto axes = result.of(sensor);
  report::Section section;
  section.id = gyro ? "gyro" : "accelerometer";
  section.title = gyro ? "Gyros" : "Accelerometers";
  report::Table table = classical_table(result, sensor);
  if (!table.rows.empty()) section.tables.push_back(std::move(table));
  report::Panel panel;
  panel.id = section.id + "-allan";
  panel.title = fmt::format("Allan deviation of {}", gyro ? "the gyros" : "the accelerometers");
  panel.caption = "Bands are 95 % intervals of each point by chi-square. The axes of one triad should look alike.";
  report::Plot& plot = panel.plots.emplace_back(allan_plot({}, unit));
  for (const CalibratedAxis* axis : axes)
    for (std::size_t i = 0; i < axis->result.curves.size(); ++i) {
      const bool several = axis->result.curves.size() > 1;
      const std::string label = several ? fmt::format("{}, {}", axis->axis.axis_name(), record_name(axis->signals[i].source))
                                        : axis->axis.axis_name();
      report::Line& line = report::add_line(plot, label, allan_series(axis->result.curves[i], unit, !several), tone_of(*axis));
      line.width_px = several ? 1.2 : 1.8;
      if (!several) line.band_label = "95 %";
    }
  section.panels.push_back(std::move(panel));
  return section;
}

}  // namespace coast::jobs
