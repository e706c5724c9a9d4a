// error_model.yaml: the estimate as input of `coast process` and `coast simulate`.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/result.hpp"
#include "calibrate/units.hpp"
#include "coast/config/quoted.hpp"
#include "coast/geo/units.hpp"

namespace coast::jobs {

namespace {

using noise::Sensor;

std::string limit(const std::optional<double>& value, const char* absent) {
  return value ? fmt::format("{:.4g}", *value) : absent;
}

// "WN density 2.41 deg/sqrt(h), 95 % 2.40 to 2.42"
std::string comment_of(const CalibratedAxis& axis, const noise::SumModel::Term& term) {
  std::string text;
  for (std::size_t i = term.parameter; i < term.parameter + term.parameters; ++i) {
    const SheetValue v = sheet_value(axis.result.best().model, i, axis.axis.sensor, axis.result.parameters[i]);
    text += fmt::format("{}{} {:.4g}{}{}", text.empty() ? "" : "; ", v.name, v.value, v.unit.empty() ? "" : " ", v.unit);
    if (!v.lower && !v.upper)
      text += ", not bounded by the record";
    else
      text += fmt::format(", 95 % {} to {}", limit(v.lower, "(no bound)"), limit(v.upper, "(no bound)"));
  }
  return text;
}

std::vector<std::array<double, 3>> levels_of(const std::vector<const CalibratedAxis*>& axes, std::size_t records) {
  std::vector<std::array<double, 3>> levels;
  if (axes.size() != 3) return levels;
  for (std::size_t r = 0; r < records; ++r) {
    auto& level = levels.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) level[i] = axes[i]->result.means[r].value(0);
  }
  return levels;
}

// Slopes are independent for every recording, so a mission's slope has their root mean square as sigma. The part explained by
// the variances of the estimates is subtracted.
std::string rate_ramp(const CalibratedAxis& axis) {
  double sum = 0.0;
  std::string list;
  const char* sheet = sheet_units(axis.axis.sensor).rate_ramp;
  for (const noise::MeanEstimate& mean : axis.result.means) {
    sum += mean.value(1) * mean.value(1) - mean.covariance(1, 1);
    list += fmt::format("{}{:.3g} +- {:.2g}", list.empty() ? "" : ", ", in_unit(mean.value(1), sheet),
                        in_unit(std::sqrt(mean.covariance(1, 1)), sheet));
  }
  if (!(sum > 0.0)) return fmt::format("    # drift of the records {} {}: none beyond its uncertainty\n", list, sheet);
  const double rms = std::sqrt(sum / static_cast<double>(axis.result.means.size()));
  return fmt::format("    # drift of the records {} {}\n    - {{process: rate_ramp, coefficient: {:.17g}, unit: {}}}\n", list,
                     sheet, rms, axis.axis.sensor == Sensor::kGyro ? "rad/s^2" : "m/s^3");
}

std::string axis_yaml(const CalibratedAxis& axis) {
  const noise::Candidate& best = axis.result.best();
  std::string text = fmt::format("    # {}\n", best.model.name());
  const auto processes = best.model.processes(best.fit.u, {axis.axis.sensor, axis.signals.front().interval});
  for (std::size_t i = 0; i < processes.size(); ++i)
    text += fmt::format("    # {}\n    - {}\n", comment_of(axis, best.model.terms()[i]), processes[i]->yaml());
  if (best.model.mean() == noise::Mean::kLevelAndDrift) text += rate_ramp(axis);
  return text;
}

noise::TurnOnBias bias_of(const CalibrationConfig& config, const CalibrationResult& result, Sensor sensor) {
  if (const auto stated = config.of(sensor).turn_on_bias) return {*stated, "stated in the calibration file"};
  const auto levels = levels_of(result.of(sensor), result.records.size());
  if (!levels.empty()) return noise::turn_on_bias(sensor, levels);
  const double fallback = sensor == Sensor::kGyro ? geo::unit("deg/s").to_si : 20.0 * geo::unit("mg").to_si;
  return {fallback,
          fmt::format("default, {}: not all three axes were calibrated", sensor == Sensor::kGyro ? "1 deg/s" : "20 mg")};
}

std::string sensor_yaml(const CalibrationConfig& config, const CalibrationResult& result, Sensor sensor) {
  const auto axes = result.of(sensor);
  std::string text = sensor == Sensor::kGyro ? "gyro:\n" : "accel:\n";
  if (axes.empty())
    return text + "  # not calibrated: zero error is assumed, which is never true. Add what is known.\n  all: []\n";
  const noise::TurnOnBias bias = bias_of(config, result, sensor);
  const std::string constant =
      fmt::format("    # turn-on bias: {}\n    - {{process: random_constant, sigma: {:.17g}, unit: {}}}\n", bias.source,
                  bias.sigma, sensor == Sensor::kGyro ? "rad/s" : "m/s^2");
  for (int i = 0; i < 3; ++i) {
    const auto own = std::ranges::find(axes, i, [](const CalibratedAxis* a) { return a->axis.axis; });
    text += fmt::format("  {}:\n", "xyz"[i]);
    if (own == axes.end()) text += fmt::format("    # not calibrated: taken from axis {}\n", axes.front()->axis.axis_name());
    text += axis_yaml(own == axes.end() ? *axes.front() : **own) + constant;
  }
  return text;
}

}  // namespace

std::string error_model_yaml(const CalibrationConfig& config, const CalibrationResult& result) {
  std::string text = fmt::format(
      "# Made by coast {} calibrate {}: maximum likelihood of static records.\n"
      "# Values are in SI units; above each stands what a data sheet would say, with its 95 % interval.\n",
      COAST_VERSION, config.file.filename().string());
  for (const ReadRecord& record : result.records)
    text += fmt::format("#   {}, {} samples, {:.0f} s\n", std::filesystem::path(record.source).filename().string(),
                        record.samples, record.duration);
  text += fmt::format("schema: coast.imu_error_model/1\nsensor: {}\nrate_hz: {:.10g}\n", config::quoted(config.sensor),
                      1.0 / result.interval);
  for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel}) text += sensor_yaml(config, result, sensor);
  return text;
}

}  // namespace coast::jobs
