#include "campaign/unit_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "coast/geo/units.hpp"
#include "outage/outage_table.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 3> kXyz{"x", "y", "z"};
constexpr std::array<const char*, 3> kNorthEastDown{"n", "e", "d"};
constexpr std::array<const char*, 3> kRollPitchYaw{"roll", "pitch", "yaw"};
constexpr std::array<const char*, 2> kSolutions{"forward", "smoothed"};

/// Three columns: what_x_unit, ..
void add_three(Json& row, const std::string& what, const std::array<const char*, 3>& axes, const char* unit,
               const Eigen::Vector3d& values) {
  for (std::size_t i = 0; i < 3; ++i) row[fmt::format("{}_{}_{}", what, axes[i], unit)] = values(static_cast<Eigen::Index>(i));
}

void add_errors(Json& row, const char* solution, const study::ErrorSummary& errors) {
  add_three(row, fmt::format("{}_rms", solution), kNorthEastDown, "m", errors.position.rms);
  add_three(row, fmt::format("{}_max", solution), kNorthEastDown, "m", errors.position.max);
  if (errors.attitude)
    add_three(row, fmt::format("{}_rms", solution), kRollPitchYaw, "deg", errors.attitude->rms / geo::kDegree);
}

void add_outages(Json& row, const std::vector<study::OutageResult>& outages) {
  if (outages.empty()) return;
  row["outage_count"] = outages.size();
  for (const bool smoothed : {false, true}) {
    if (smoothed && !outages.front().smoothed) continue;
    double largest = 0.0, squares = 0.0;
    for (const study::OutageResult& outage : outages) {
      const double drift = (smoothed ? *outage.smoothed : outage.forward).horizontal_max_m;
      largest = std::max(largest, drift);
      squares += drift * drift;
    }
    row[fmt::format("{}_outage_max_m", kSolutions[smoothed ? 1 : 0])] = largest;
    row[fmt::format("{}_outage_rms_m", kSolutions[smoothed ? 1 : 0])] =
        std::sqrt(squares / static_cast<double>(outages.size()));
  }
}

void add_estimates(std::vector<CampaignEstimated>& list, const std::string& quantity, const char* unit,
                   const Eigen::Vector3d& value, const Eigen::Vector3d& sigma) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    if (sigma(axis) > 0.0) list.push_back({quantity, kXyz[i], value(axis), sigma(axis), unit});
  }
}

/// Noise that was fitted: the optimum, and its sigma from that of the logarithm.
void add_noise(std::vector<CampaignEstimated>& list, const estimate::NoiseFit& fit) {
  const estimate::NoiseAdjustment& a = fit.adjustment;
  const auto add = [&](const std::string& name, const std::string& quantity, const char* axis, double value, const char* unit) {
    const auto place = std::ranges::find(fit.names, name) - fit.names.begin();
    const auto i = static_cast<std::size_t>(place);
    if (i >= fit.names.size() || i >= fit.log_sd.size() || !std::isfinite(fit.log_sd[i])) return;
    list.push_back({quantity, axis, value, value * fit.log_sd[i], unit});
  };
  for (std::size_t i = 0; i < 3; ++i) {
    add(fmt::format("gyro_factor_{}", kXyz[i]), "gyro_factor", kXyz[i], a.gyro_factors(static_cast<Eigen::Index>(i)), "1");
    add(fmt::format("accel_factor_{}", kXyz[i]), "accel_factor", kXyz[i], a.accel_factors(static_cast<Eigen::Index>(i)), "1");
  }
  add("gnss_scale_horizontal", "gnss_scale", "horizontal", a.gnss_scale.horizontal, "1");
  add("gnss_scale_vertical", "gnss_scale", "vertical", a.gnss_scale.vertical, "1");
  add("gnss_scale_velocity", "gnss_scale", "velocity", a.gnss_scale.velocity, "1");
  add("correlated_horizontal_m", "correlated_gnss", "horizontal", a.correlated_gnss.horizontal_m, "m");
  add("correlated_vertical_m", "correlated_gnss", "vertical", a.correlated_gnss.vertical_m, "m");
}

/// States that are no biases: "gyro_x scale_factor" is gyro_scale_factor of x, "vehicle_mounting_0" mounting of pitch.
void add_states(std::vector<CampaignEstimated>& list, const std::vector<StateTrack>& tracks) {
  std::vector<std::string> seen;
  for (const StateTrack& track : tracks) {
    const std::vector<double>& values = track.smoothed.empty() ? track.forward : track.smoothed;
    const std::vector<double>& sigmas = track.smoothed.empty() ? track.forward_sd : track.smoothed_sd;
    if (values.empty() || !(sigmas.back() > 0.0)) continue;
    if (track.name.starts_with("vehicle_mounting_")) {
      list.push_back({"mounting", track.name.ends_with('0') ? "pitch" : "yaw", values.back(), sigmas.back(), "rad"});
      continue;
    }
    const std::size_t space = track.name.find(' ');
    if (space == std::string::npos || space < 2 || track.name[space - 2] != '_') continue;
    const std::string process = track.name.substr(space + 1);
    const bool scale = process.starts_with("scale_factor");
    if (!scale && !process.starts_with("misalignment")) continue;
    // An axis has two misalignments: its angle to the next axis, then that to the previous one.
    std::string axis = track.name.substr(space - 1, 1);
    const bool second = std::ranges::find(seen, track.name) != seen.end();
    seen.push_back(track.name);
    if (!scale) {
      const auto own = static_cast<std::size_t>(axis[0] - 'x');
      axis += kXyz[(own + (second ? 2U : 1U)) % 3];
    }
    list.push_back({track.name.substr(0, space - 2) + "_" + process, axis, values.back(), sigmas.back(), scale ? "1" : "rad"});
  }
}

std::string iso(geo::GpsTime t) {
  std::string text = geo::to_string(t);  // "2025-07-08 19:34:18.499 GPST"
  text = text.substr(0, text.rfind(' '));
  std::ranges::replace(text, ' ', 'T');
  return text;
}

}  // namespace

const std::vector<std::string>& mission_columns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> names{"verdict",      "likely_cause",  "start",           "duration_s",
                                   "gnss_epochs",  "gnss_used",     "gnss_rejected",   "nis_mean",
                                   "nis_expected", "time_offset_s", "time_offset_sd_s"};
    const auto three = [&names](const std::string& what, const std::array<const char*, 3>& axes, const char* unit) {
      for (const char* axis : axes) names.push_back(fmt::format("{}_{}_{}", what, axis, unit));
    };
    for (const std::string solution : kSolutions) {
      three(solution + "_rms", kNorthEastDown, "m");
      three(solution + "_max", kNorthEastDown, "m");
      three(solution + "_rms", kRollPitchYaw, "deg");
    }
    names.emplace_back("outage_count");
    for (const std::string solution : kSolutions)
      for (const char* what : {"_outage_max_m", "_outage_rms_m"}) names.push_back(solution + what);
    three("lever_arm", kXyz, "m");
    three("lever_arm_sd", kXyz, "m");
    three("gyro_bias", kXyz, "radps");
    three("gyro_bias_sd", kXyz, "radps");
    three("accel_bias", kXyz, "mps2");
    three("accel_bias_sd", kXyz, "mps2");
    names.insert(names.end(), {"findings", "log_likelihood_gain_per_epoch"});
    return names;
  }();
  return columns;
}

std::string temperature_of(const record::ImuRecording& imu) {
  if (imu.temperature.empty()) return {};
  const double sum = std::accumulate(imu.temperature.begin(), imu.temperature.end(), 0.0);
  return fmt::format("{:.2f}", sum / static_cast<double>(imu.temperature.size()));
}

std::string device_of(const RunConfig& config) {
  if (config.imu_name.empty() && config.imu_serial.empty()) return config.setup.model.sensor_name();
  if (config.imu_name.empty() || config.imu_serial.empty()) return config.imu_name + config.imu_serial;
  return config.imu_name + " " + config.imu_serial;
}

UnitResult unit_result(const ProcessResult& result) {
  UnitResult unit;
  Json& row = unit.row;
  row["verdict"] = name(result.verdict.standing());
  row["likely_cause"] = result.verdict.likely_cause;
  row["start"] = iso(result.start);
  row["duration_s"] = result.end - result.start;
  row["gnss_epochs"] = result.gnss_epochs;
  row["gnss_used"] = result.gnss_used;
  row["gnss_rejected"] = result.gnss_rejected;
  if (result.nis.epochs > 0) {
    row["nis_mean"] = result.nis.mean;
    row["nis_expected"] = result.nis.expected;
  }
  row["time_offset_s"] = result.time_offset_s;
  if (result.time_offset_sd_s) {
    row["time_offset_sd_s"] = *result.time_offset_sd_s;
    unit.estimates.push_back({"time_offset", "", result.time_offset_s, *result.time_offset_sd_s, "s"});
  }
  if (result.reference) {
    add_errors(row, "forward", result.reference->summary(result.reference->forward));
    if (result.reference->smoothed) add_errors(row, "smoothed", result.reference->summary(*result.reference->smoothed));
  }
  std::vector<study::OutageResult> outages = result.outages;
  outages.insert(outages.end(), result.sweep.begin(), result.sweep.end());
  add_outages(row, outages);
  for (const study::OutageResult& outage : outages) unit.outages.push_back(outage_line(outage.outage.start.sow(), outage));

  // Where the run did not estimate the lever arm, what a second run beside it has found.
  Eigen::Vector3d arm = result.lever_arm_used_b;
  Eigen::Vector3d sd = result.lever_arm_sd_m.value_or(Eigen::Vector3d::Zero());
  if (!result.lever_arm_sd_m && result.lever_arm) {
    arm += result.lever_arm->difference_m;
    sd = result.lever_arm->sd_m;
  }
  add_three(row, "lever_arm", kXyz, "m", arm);
  if (sd.x() > 0.0) add_three(row, "lever_arm_sd", kXyz, "m", sd);
  const SensorBiases& biases = result.biases;
  add_three(row, "gyro_bias", kXyz, "radps", biases.gyro);
  add_three(row, "gyro_bias_sd", kXyz, "radps", biases.gyro_sd);
  add_three(row, "accel_bias", kXyz, "mps2", biases.accel);
  add_three(row, "accel_bias_sd", kXyz, "mps2", biases.accel_sd);
  add_estimates(unit.estimates, "lever_arm", "m", arm, sd);
  add_estimates(unit.estimates, "gyro_bias", "rad/s", biases.gyro, biases.gyro_sd);
  add_estimates(unit.estimates, "accel_bias", "m/s^2", biases.accel, biases.accel_sd);
  add_states(unit.estimates, result.states);
  if (result.noise_fit) add_noise(unit.estimates, *result.noise_fit);
  return unit;
}

UnitResult unit_result(const OutageStudy& study) {
  UnitResult unit;
  std::vector<study::OutageResult> all;
  for (const study::ModelRun& run : study.result.runs)
    for (std::size_t g = 0; g < run.outages.size(); ++g)
      for (std::size_t i = 0; i < run.outages[g].size(); ++i) {
        unit.outages.push_back(outage_line(study.result.groups[g].starts_s[i / study.result.seeds], run.outages[g][i]));
        all.push_back(run.outages[g][i]);
      }
  add_outages(unit.row, all);
  return unit;
}

UnitResult unit_result(const DiagnosisResult& result) {
  UnitResult unit;
  const diagnose::Diagnosis& d = result.diagnosis;
  unit.row["start"] = iso(result.start);
  unit.row["duration_s"] = result.end - result.start;
  std::string names;
  for (const diagnose::Finding& f : d.findings) {
    const std::string sensor(diagnose::name(f.hypothesis.effect->site));
    names += fmt::format("{}{} {} {}", names.empty() ? "" : "; ", f.hypothesis.effect->name, sensor, f.hypothesis.axis_name());
    if (f.sd > 0.0)
      unit.estimates.push_back({fmt::format("{} {}", sensor, f.hypothesis.effect->name), f.hypothesis.axis_name(), f.value,
                                f.sd, std::string(f.hypothesis.effect->unit)});
  }
  for (const diagnose::NoiseFinding& f : d.noise) {
    names += fmt::format("{}{} {} {}", names.empty() ? "" : "; ", f.name, f.sensor, f.axis);
    if (f.sd > 0.0) unit.estimates.push_back({fmt::format("{} {}", f.sensor, f.name), f.axis, f.value, f.sd, f.unit});
  }
  unit.row["findings"] = names;
  unit.row["log_likelihood_gain_per_epoch"] = d.after.log_likelihood_per_epoch - d.before.log_likelihood_per_epoch;
  return unit;
}

std::string outage_line(double start_s, const study::OutageResult& outage) {
  return fmt::format("{},{},{}", start_s, outage.outage.duration_s, outage_values(outage));
}

std::optional<study::OutageResult> outage_from_line(std::string_view line) {
  const std::size_t start = line.find(',');
  const std::size_t duration = start == std::string_view::npos ? start : line.find(',', start + 1);
  if (duration == std::string_view::npos) return std::nullopt;
  std::optional<study::OutageResult> outage = outage_from(line.substr(duration + 1));
  const std::string_view seconds = line.substr(start + 1, duration - start - 1);
  if (outage) std::from_chars(seconds.data(), seconds.data() + seconds.size(), outage->outage.duration_s);
  return outage;
}

std::string result_json(const UnitResult& result, const UnitCost& cost) {
  Json j;
  j["schema"] = "coast.campaign_unit/1";
  if (!result.error.empty()) j["error"] = result.error;
  j["imu"] = result.imu;
  if (!result.temperature.empty()) j["temperature_degC"] = result.temperature;
  j["row"] = result.row;
  j["outages"] = result.outages;
  j["estimates"] = Json::array();
  for (const CampaignEstimated& e : result.estimates) j["estimates"].push_back({e.quantity, e.axis, e.value, e.sigma, e.unit});
  j["cost"] = {{"seconds", cost.seconds}, {"memory_bytes", cost.memory_bytes}};
  return j.dump() + "\n";
}

std::optional<UnitResult> result_from(const std::string& json) {
  const Json j = Json::parse(json, nullptr, false);
  if (j.is_discarded() || !j.is_object() || j.value("schema", "") != "coast.campaign_unit/1") return std::nullopt;
  try {
    UnitResult result;
    result.error = j.value("error", "");
    result.imu = j.value("imu", "");
    result.temperature = j.value("temperature_degC", "");
    result.row = j.at("row");
    result.outages = j.at("outages").get<std::vector<std::string>>();
    for (const Json& e : j.at("estimates")) result.estimates.push_back({e.at(0), e.at(1), e.at(2), e.at(3), e.at(4)});
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::optional<UnitCost> cost_from(const std::string& json) {
  const Json j = Json::parse(json, nullptr, false);
  if (j.is_discarded() || !j.is_object() || !j.contains("cost")) return std::nullopt;
  return UnitCost{j["cost"].value("seconds", 0.0), j["cost"].value("memory_bytes", 0.0)};
}

}  // namespace coast::jobs
