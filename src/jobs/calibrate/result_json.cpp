// calibration.json: all results; values that the records do not determine are absent.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calibrate/result.hpp"
#include "calibrate/units.hpp"
#include "common/error_json.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostOutliers = 200;  // listed individually

void put(Json& j, const char* key, const std::optional<double>& value) {
  constexpr double kAsGoodAsInfinite = 1e100;  // an eigenvalue that is zero except for rounding
  if (value && std::abs(*value) < kAsGoodAsInfinite) j[key] = *value;
}

Json parameter_json(const CalibratedAxis& axis, std::size_t i) {
  const noise::ParameterEstimate& p = axis.result.parameters[i];
  const noise::SumModel& model = axis.result.best().model;
  Json j = {{"name", p.name}, {"value", p.value}, {"unit", si_unit_of(model.parameter(i).unit, axis.axis.sensor)}};
  put(j, "lower_95", p.lower);
  put(j, "upper_95", p.upper);
  put(j, "cramer_rao_relative_sd", p.relative_bound);
  put(j, "record_for_25_percent_s", p.duration_for_quarter);
  const SheetValue sheet = sheet_value(model, i, axis.axis.sensor, p);
  Json& data_sheet = j["data_sheet"] = {{"name", sheet.name}, {"value", sheet.value}, {"unit", sheet.unit}};
  put(data_sheet, "lower_95", sheet.lower);
  put(data_sheet, "upper_95", sheet.upper);
  return j;
}

Json candidate_json(const noise::Candidate& c, bool chosen) {
  Json j = {{"model", c.model.name()}, {"parameters", c.parameters}};
  put(j, "log_likelihood", c.fit.log_likelihood);
  put(j, "compared_log_likelihood", c.compared_log_likelihood);
  put(j, "bic", c.bic);
  put(j, "aicc", c.aicc);
  put(j, "held_out_per_sample", c.held_out);
  j["on_all_samples"] = c.on_all_samples;
  j["converged"] = c.fit.converged;
  j["degenerate"] = c.degenerate;
  j["chosen"] = chosen;
  return j;
}

Json mean_json(const noise::MeanEstimate& mean, const std::vector<noise::ProfileInterval>& intervals) {
  constexpr std::array kNames{"level", "drift_per_s"};
  Json j = Json::object();
  for (Eigen::Index k = 0; k < mean.value.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    Json& of = j[kNames[at]] = {{"value", mean.value(k)}, {"sd", std::sqrt(mean.covariance(k, k))}};
    put(of, "lower_95", intervals[at].lower);
    put(of, "upper_95", intervals[at].upper);
  }
  return j;
}

Json curve_json(const noise::AllanCurve& curve) {
  Json j;
  for (const char* key : {"tau_s", "deviation", "lower_95", "upper_95", "edf", "hadamard"}) j[key] = Json::array();
  for (const noise::AllanPoint& point : curve) {
    j["tau_s"].push_back(point.tau);
    j["deviation"].push_back(point.allan.value);
    j["lower_95"].push_back(point.allan.interval_95.lower);
    j["upper_95"].push_back(point.allan.interval_95.upper);
    j["edf"].push_back(point.allan.edf);
    j["hadamard"].push_back(point.hadamard.value);
  }
  return j;
}

Json classical_json(const noise::AllanReading& reading, noise::Sensor sensor) {
  Json list = Json::array();
  const auto add = [&](const char* name, const std::optional<noise::CoefficientReading>& c, const char* unit) {
    if (!c) return;
    list.push_back({{"name", name},
                    {"value", in_unit(c->value, unit)},
                    {"unit", unit},
                    {"lower_95", in_unit(c->interval_95.lower, unit)},
                    {"upper_95", in_unit(c->interval_95.upper, unit)},
                    {"tau_from_s", c->tau_from},
                    {"tau_to_s", c->tau_to}});
  };
  const SheetUnits& units = sheet_units(sensor);
  add("white_noise", reading.white_noise, units.white_noise);
  add("bias_instability", reading.bias_instability, units.signal);
  add("rate_random_walk", reading.rate_random_walk, units.rate_random_walk);
  add("rate_ramp", reading.rate_ramp, units.rate_ramp);
  add("quantisation", reading.quantisation, units.integral);
  return list;
}

Json outliers_json(const noise::AxisCalibration& result) {
  const auto excluded = std::ranges::count_if(result.outliers, &noise::Outlier::excluded);
  Json j = {{"count", result.outliers.size()}, {"excluded", excluded}, {"first", Json::array()}};
  for (const noise::Outlier& o : result.outliers) {
    if (j["first"].size() == kMostOutliers) break;
    j["first"].push_back({{"record", o.record}, {"time_s", o.time_s}, {"sigmas", o.sigmas}, {"excluded", o.excluded}});
  }
  return j;
}

Json band_json(const noise::CurveBand& band) {
  return {{"inside", band.inside},
          {"tau_s", band.tau},
          {"lower_95", band.lower},
          {"median", band.median},
          {"upper_95", band.upper}};
}

Json whiteness_json(const noise::Whiteness& whiteness) {
  return {{"autocorrelation", whiteness.autocorrelation}, {"p_value", whiteness.p_value}};
}

Json test_json(const TestedRecord& tested) {
  Json j = {{"source", tested.source},
            {"log_likelihood_per_sample", tested.test.log_likelihood_per_sample},
            {"innovation_variance", tested.test.innovation_variance},
            {"innovations", whiteness_json(tested.test.whiteness)},
            {"allan", curve_json(tested.test.curve)}};
  if (!tested.test.band.tau.empty()) j["allan_band"] = band_json(tested.test.band);
  return j;
}

Json own_json(const CalibratedAxis& axis) {
  Json list = Json::array();
  const noise::SumModel& model = axis.result.best().model;
  for (const OwnEstimate& own : axis.own) {
    Json values = Json::array();
    for (std::size_t i = 0; i < own.u.size(); ++i) {
      Json j = {{"name", model.parameter_name(i)}, {"value", model.parameter(i).value(own.u[i])}};
      put(j, "cramer_rao_relative_sd", own.sd[i]);
      values.push_back(std::move(j));
    }
    list.push_back(std::move(values));
  }
  return list;
}

Json record_json(const ReadRecord& r) {
  return {{"source", r.source}, {"samples", r.samples}, {"duration_s", r.duration}, {"holes", r.holes}, {"remarks", r.remarks}};
}

Json axis_json(const CalibratedAxis& axis) {
  const noise::AxisCalibration& r = axis.result;
  const noise::Candidate& best = r.best();
  std::size_t samples = 0;
  for (const noise::StaticSignal& signal : axis.signals) samples += signal.values.size();
  Json j = {{"sensor", axis.axis.sensor_name()},
            {"axis", axis.axis.axis_name()},
            {"model", best.model.name()},
            {"log_likelihood", best.fit.log_likelihood},
            {"samples", samples}};
  j["parameters"] = Json::array();
  for (std::size_t i = 0; i < r.parameters.size(); ++i) j["parameters"].push_back(parameter_json(axis, i));
  j["means"] = Json::array();
  for (std::size_t i = 0; i < r.means.size(); ++i) j["means"].push_back(mean_json(r.means[i], r.mean_intervals[i]));
  j["identifiable_combinations"] = Json::array();
  for (const noise::Combination& c : r.combinations) {
    j["identifiable_combinations"].push_back({{"combination", c.text}});
    put(j["identifiable_combinations"].back(), "relative_sd", c.relative_sd);
  }
  j["remarks"] = r.remarks;
  j["classical"] = classical_json(r.reading, axis.axis.sensor);
  j["candidates"] = Json::array();
  for (std::size_t i = 0; i < r.candidates.size(); ++i)
    j["candidates"].push_back(candidate_json(r.candidates[i], i == r.chosen));
  j["innovations"] = whiteness_json(r.whiteness);
  j["outliers"] = outliers_json(r);
  j["allan"] = Json::array();
  for (const noise::AllanCurve& curve : r.curves) j["allan"].push_back(curve_json(curve));
  if (!r.band.tau.empty()) j["allan_band"] = band_json(r.band);
  put(j, "common_parameters_p_value", r.common_parameters_p);
  if (!axis.own.empty()) j["records_alone"] = own_json(axis);
  for (const TestedRecord& tested : axis.tests) j["tests"].push_back(test_json(tested));
  return j;
}

}  // namespace

std::string calibration_json(const CalibrationConfig& config, const CalibrationResult& result) {
  Json j = {{"schema", "coast.calibration/1"}, {"sensor", config.sensor}, {"rate_hz", 1.0 / result.interval}};
  j["records"] = Json::array();
  for (const ReadRecord& r : result.records) j["records"].push_back(record_json(r));
  for (const ReadRecord& r : result.tested_on) j["tested_on"].push_back(record_json(r));
  j["events"] = events_json(result.events);
  j["axes"] = Json::array();
  for (const CalibratedAxis& axis : result.axes) j["axes"].push_back(axis_json(axis));
  j["files"] = {{"error_model", "error_model.yaml"}, {"report", "report.html"}};
  return j.dump(1) + "\n";
}

}  // namespace coast::jobs
