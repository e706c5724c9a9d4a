#include "evidence/noise_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "coast/noise/chi_square.hpp"

namespace coast::diagnose {

namespace {

constexpr double kLongestFit = 600.0;  // s: the filter runs a hundred times over it

/// Sums over one component of one kind of innovation.
struct ComponentSums {
  double count = 0.0;
  double squares = 0.0;
  double products = 0.0;  ///< with the previous one
  double before = 0.0;
  void add(double u) {
    products += u * before;
    squares += u * u;
    before = u;
    count += 1.0;
  }
  [[nodiscard]] double deviation() const {
    if (count < 30.0) return 0.0;
    const double variance = std::abs(squares / count - 1.0) * std::sqrt(count / 2.0);
    return std::max(variance, std::abs(products / squares) * std::sqrt(count));
  }
};

struct ParameterWords {
  std::string_view parameter;  ///< as in estimate::NoiseFit
  const char* name;
  const char* sensor;
  const char* axis;
  const char* called;
  const char* unit;
  bool is_factor;
};
constexpr std::array<ParameterWords, 6> kWords{{
    {"gnss_scale_horizontal", "gnss_sd_optimistic", "gnss", "horizontal", "factor", "1", true},
    {"gnss_scale_vertical", "gnss_sd_optimistic", "gnss", "d", "factor", "1", true},
    {"gnss_scale_velocity", "gnss_sd_optimistic", "gnss", "velocity", "factor", "1", true},
    {"correlated_horizontal_m", "gnss_correlated_error", "gnss", "horizontal", "sigma", "m", false},
    {"correlated_vertical_m", "gnss_correlated_error", "gnss", "d", "sigma", "m", false},
    {"correlated_time_s", "gnss_correlated_error", "gnss", "horizontal", "correlation_time", "s", false},
}};

double value_of(const estimate::NoiseAdjustment& a, std::string_view parameter) {
  if (parameter == "gnss_scale_horizontal") return a.gnss_scale.horizontal;
  if (parameter == "gnss_scale_vertical") return a.gnss_scale.vertical;
  if (parameter == "gnss_scale_velocity") return a.gnss_scale.velocity;
  if (parameter == "correlated_horizontal_m") return a.correlated_gnss.horizontal_m;
  if (parameter == "correlated_vertical_m") return a.correlated_gnss.vertical_m;
  return a.correlated_gnss.time_s;
}

constexpr double kBeyondChance = 3.0;  // sd

/// The white noise of a sensor's three axes: one factor if they do not differ significantly. Nothing if it is as stated.
std::optional<NoiseFinding> of_triad(const estimate::NoiseFit& fit, const char* sensor, const Eigen::Vector3d& factors,
                                     double p_value) {
  const auto first = std::ranges::find(fit.names, fmt::format("{}_factor_x", sensor)) - fit.names.begin();
  Eigen::Vector3d sd;
  for (int axis = 0; axis < 3; ++axis) sd(axis) = fit.log_sd[static_cast<std::size_t>(first + axis)];
  const Eigen::Vector3d logs = factors.array().log(), information = sd.cwiseAbs2().cwiseInverse();
  if (!(information.sum() > 0.0)) return std::nullopt;
  const double mean = logs.dot(information) / information.sum();
  const double mean_sd = 1.0 / std::sqrt(information.sum());
  const Eigen::Vector3d beside = (logs.array() - mean).abs() / sd.array();  // none where the data know nothing
  const bool alike = beside.maxCoeff() < kBeyondChance;
  if (alike && std::abs(mean) < kBeyondChance * mean_sd) return std::nullopt;
  NoiseFinding finding{.name = "imu_white_noise",
                       .sensor = sensor,
                       .parameter = "factor",
                       .unit = "1",
                       .value = std::exp(mean),
                       .sd = std::exp(mean) * mean_sd,
                       .delta_log_likelihood = fit.log_likelihood_after - fit.log_likelihood_before,
                       .p_value = p_value};
  if (!alike) finding.by_axis = factors;
  return finding;
}

/// Those parameters of the fit that differ significantly from neutral.
std::vector<NoiseFinding> findings_of(const estimate::NoiseFit& fit, double p_value) {
  std::vector<NoiseFinding> findings;
  for (std::size_t i = 0; i < fit.names.size(); ++i) {
    const auto words = std::ranges::find(kWords, fit.names[i], &ParameterWords::parameter);
    if (words == kWords.end() || words->parameter == "correlated_time_s" || !(fit.log_sd[i] > 0.0)) continue;
    const double value = value_of(fit.adjustment, fit.names[i]);
    // A factor is significant by its standard deviation; an amplitude if the likelihood needs it.
    const bool is_told = words->is_factor ? std::abs(std::log(value)) > kBeyondChance * fit.log_sd[i]
                                          : fit.needed[i] > 0.5 * kBeyondChance * kBeyondChance;
    if (!is_told) continue;
    findings.push_back({.name = words->name,
                        .sensor = words->sensor,
                        .axis = words->axis,
                        .parameter = words->called,
                        .unit = words->unit,
                        .value = value,
                        .sd = std::isfinite(fit.log_sd[i]) ? value * fit.log_sd[i] : 0.0,
                        .delta_log_likelihood = fit.log_likelihood_after - fit.log_likelihood_before,
                        .p_value = p_value});
    if (words->is_factor) continue;
    findings.back().time_s = fit.adjustment.correlated_gnss.time_s;
    const auto time = std::ranges::find(fit.names, "correlated_time_s") - fit.names.begin();
    if (const double log_sd = fit.log_sd[static_cast<std::size_t>(time)]; std::isfinite(log_sd))
      findings.back().time_sd_s = findings.back().time_s * log_sd;
  }
  for (const auto& found : {of_triad(fit, "gyro", fit.adjustment.gyro_factors, p_value),
                            of_triad(fit, "accel", fit.adjustment.accel_factors, p_value)})
    if (found) findings.push_back(*found);
  return findings;
}

}  // namespace

double contradiction(const std::vector<estimate::InnovationRecord>& innovations) {
  std::array<std::array<ComponentSums, 3>, 2> sums;
  for (const estimate::InnovationRecord& r : innovations) {
    const bool position = estimate::is_position(r.kind);
    if (!r.used || (!position && r.kind != estimate::UpdateKind::kGnssVelocity)) continue;
    for (int i = 0; i < 3; ++i) sums[position ? 0 : 1][static_cast<std::size_t>(i)].add(r.nu(i) / r.sd(i));
  }
  double largest = 0.0;
  for (const auto& kind : sums)
    for (const ComponentSums& component : kind) largest = std::max(largest, component.deviation());
  return largest;
}

std::optional<FittedNoise> fitted_noise(const study::PreparedMission& mission, const std::optional<estimate::NoiseFit>& before,
                                        const study::Progress& progress) {
  constexpr estimate::NoiseFitChoice kAll{
      .gnss_scale = true, .correlated_gnss = true, .imu_white_noise = true, .precision = estimate::FitPrecision::kSearch};
  FittedNoise fitted{
      mission.fit(kAll, before ? before->adjustment : estimate::starting_point(mission.options(), kAll), kLongestFit, progress),
      {}};
  const double p_value = noise::chi2_survival(static_cast<double>(fitted.fit.names.size()), 2.0 * std::max(0.0, fitted.gain()));
  if (p_value > 0.01) return std::nullopt;
  fitted.findings = findings_of(fitted.fit, p_value);
  return fitted;
}

}  // namespace coast::diagnose
