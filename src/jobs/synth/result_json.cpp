// synth.json: all results for an array.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "coast/geo/units.hpp"
#include "common/error_json.hpp"
#include "synth/config.hpp"
#include "synth/result.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;

Json lag_json(const array::LagCurve& lag) {
  Json j = {{"offset_s", lag.offset_s}, {"offset_sigma_s", lag.offset_sigma_s}};
  if (std::isfinite(lag.drift_sigma_ppm)) {
    j["drift_ppm"] = lag.drift_ppm;
    j["drift_sigma_ppm"] = lag.drift_sigma_ppm;
  }
  j["windows"] = lag.windows.size();
  j["windows_left_out"] = lag.left_out.size();
  return j;
}

Json clock_json(const array::ClockFit& clock) {
  return {{"offset_s", clock.offset_s},
          {"drift_ppm", clock.drift_ppm},
          {"offset_sigma_s", clock.offset_sigma_s},
          {"drift_sigma_ppm", clock.drift_sigma_ppm},
          {"residual_median_s", clock.residuals.median},
          {"residual_95_s", clock.residuals.percentile95}};
}

Json packets_json(const array::TimedRecording& timed) {
  Json j = {{"received", timed.report.received},
            {"lost", timed.report.lost},
            {"doubled", timed.report.doubled},
            {"reordered", timed.report.reordered},
            {"restarts", timed.report.restarts()}};
  j["clocks"] = Json::array();
  for (const array::ClockFit& clock : timed.clocks) j["clocks"].push_back(clock_json(clock));
  return j;
}

Json mounting_json(const array::RefinedSensor& sensor) {
  return {{"rotation_deg", degrees_json(sensor.rotation)},
          {"rotation_sd_deg", degrees_json(sensor.rotation_sd)},
          {"position_m", array_json(sensor.frame.r_b)},
          {"position_sd_m", array_json(sensor.position_sd_m)}};
}

Json imu_json(const ArrayConfig& config, const SynthResult& result, std::size_t k) {
  const array::Assembly& assembly = result.assembly;
  Json j = {{"name", config.imus[k].name}, {"source", result.sources[k]}};
  if (k < result.timed.size()) j["packets"] = packets_json(result.timed[k]);
  if (k < assembly.lags.size() && assembly.lags[k]) j["lag"] = lag_json(*assembly.lags[k]);
  if (assembly.mounting) j["mounting"] = mounting_json(assembly.mounting->sensors[k]);
  return j;
}

Json model_json(const noise::ArmaGarchFit& fit) {
  return {{"alpha", fit.model.alpha}, {"beta", fit.model.beta},    {"gamma0", fit.model.gamma0},
          {"gamma", fit.model.gamma}, {"delta", fit.model.delta},  {"log_likelihood", fit.log_likelihood},
          {"aicc", fit.aicc()},       {"converged", fit.converged}};
}

Json channel_json(const ArrayConfig& config, const SynthResult& result, int c) {
  const auto at = static_cast<std::size_t>(c);
  const array::MergedChannel& channel = result.channels[at];
  const std::vector<double> own = own_sds(channel);
  Json j = {{"name", channel_name(c)}, {"unit", c < 3 ? "rad/s" : "m/s^2"}};
  j["sensors"] = Json::array();
  for (std::size_t k = 0; k < own.size(); ++k) {
    Json sensor = {
        {"name", config.imus[k].name}, {"noise_sd", own[k]}, {"weight", channel.weight(static_cast<Eigen::Index>(k))}};
    if (!channel.models.empty()) sensor["arma_garch"] = model_json(channel.models[k]);
    if (!result.against_reference.empty()) sensor["reference_sd"] = result.against_reference[at].sensors[k];
    j["sensors"].push_back(std::move(sensor));
  }
  j["plain_mean_sd"] = plain_sd(channel);
  j["merged_sd"] = merged_sd(channel);
  if (!result.against_reference.empty()) {
    j["plain_mean_reference_sd"] = result.against_reference[at].plain;
    j["merged_reference_sd"] = result.against_reference[at].merged;
  }
  if (!result.remaining.empty()) j["remaining"] = result.remaining[at].in_words;
  return j;
}

Json defect_json(const ArrayConfig& config, const SynthResult& result, const array::Defect& defect) {
  const array::Signals& signals = result.assembly.signals;
  const auto sow = [&](std::size_t n) { return (signals.start + static_cast<double>(n) * signals.dt).sow(); };
  Json channels = Json::array();
  for (int c = 0; c < array::kChannels; ++c)
    if (((defect.channels >> c) & 1U) != 0) channels.push_back(channel_name(c));
  Json j = {{"imu", config.imus.at(defect.sensor).name},
            {"kind", array::name_of(defect.kind)},
            {"channels", channels},
            {"from_s", sow(defect.from)},
            {"to_s", sow(defect.to)},
            {"found_s", sow(defect.found)},
            {"statistic", defect.statistic}};
  if (defect.size) j["size"] = *defect.size;
  return j;
}

Json disagreement_json(const ArrayConfig& config, const SynthResult& result, const array::Disagreement& d) {
  const array::Signals& signals = result.assembly.signals;
  return {{"imus", {config.imus.at(d.a).name, config.imus.at(d.b).name}},
          {"channel", channel_name(d.channel)},
          {"found_s", (signals.start + static_cast<double>(d.found) * signals.dt).sow()},
          {"statistic", d.statistic}};
}

Json merge_json(const ArrayConfig& config) {
  const noise::ArmaGarchOrders& orders = config.merge.orders;
  Json j = {{"method", merge_name(config.merge.merge)}};
  if (config.merge.merge == array::Merge::kGarch || config.merge.merge == array::Merge::kCorrected) {
    if (config.merge.choose_orders)
      j["orders"] = "auto";
    else
      j["orders"] = {orders.ar, orders.ma, orders.arch, orders.garch};
  }
  return j;
}

}  // namespace

std::string synth_json(const ArrayConfig& config, const SynthResult& result) {
  const array::Signals& signals = result.assembly.signals;
  Json j = {{"schema", "coast.synth/1"},
            {"grid",
             {{"gps_week", signals.start.week()},
              {"start_s", signals.start.sow()},
              {"rate_hz", 1.0 / signals.dt},
              {"samples", signals.samples()}}},
            {"merge", merge_json(config)}};
  if (result.computer) j["computer_clock"] = clock_json(*result.computer);
  j["imus"] = Json::array();
  for (std::size_t k = 0; k < config.imus.size(); ++k) j["imus"].push_back(imu_json(config, result, k));
  j["angular_acceleration"] = {{"half_width", result.assembly.differentiator_half_width},
                               {"error_sd_radps2", result.assembly.alpha_error_sd}};
  j["channels"] = Json::array();
  for (int c = 0; c < array::kChannels; ++c) j["channels"].push_back(channel_json(config, result, c));
  j["defects"] = Json::array();
  for (const array::Defect& defect : result.assembly.defects.defects)
    j["defects"].push_back(defect_json(config, result, defect));
  j["disagreements"] = Json::array();
  for (const array::Disagreement& d : result.assembly.defects.disagreements)
    j["disagreements"].push_back(disagreement_json(config, result, d));
  j["events"] = events_json(result.events);
  return j.dump(2) + "\n";
}

}  // namespace coast::jobs
