// The noise fitted to the innovations, with the stated one.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

using estimate::NoiseAdjustment;

/// Presentation of a fitted parameter.
struct FittedParameter {
  const char* name;  ///< as in estimate::NoiseFit::names
  const char* label;
  const char* unit;  ///< "" : a factor on the stated sigma
  double (*value)(const NoiseAdjustment&);
  const char* subject;  ///< of a clause about the factor; nullptr: no clause
};

template <auto Factors, Eigen::Index Axis>
double factor(const NoiseAdjustment& adjustment) {
  return (adjustment.*Factors)(Axis);
}

constexpr FittedParameter kParameters[] = {
    {"gnss_scale_horizontal", "GNSS sigma, horizontal", "", [](const NoiseAdjustment& a) { return a.gnss_scale.horizontal; },
     "the stated horizontal sigmas of the GNSS positions are"},
    {"gnss_scale_vertical", "GNSS sigma, vertical", "", [](const NoiseAdjustment& a) { return a.gnss_scale.vertical; },
     "the stated vertical sigmas of the GNSS positions are"},
    {"gnss_scale_velocity", "GNSS sigma, velocity", "", [](const NoiseAdjustment& a) { return a.gnss_scale.velocity; },
     "the stated sigmas of the GNSS velocities are"},
    {"correlated_horizontal_m", "correlated GNSS error, horizontal", "m",
     [](const NoiseAdjustment& a) { return a.correlated_gnss.horizontal_m; }, nullptr},
    {"correlated_vertical_m", "correlated GNSS error, vertical", "m",
     [](const NoiseAdjustment& a) { return a.correlated_gnss.vertical_m; }, nullptr},
    {"correlated_time_s", "correlation time of it", "s", [](const NoiseAdjustment& a) { return a.correlated_gnss.time_s; },
     nullptr},
    {"gyro_factor_x", "gyro x white noise", "", factor<&NoiseAdjustment::gyro_factors, 0>, "the white noise of gyro x is"},
    {"gyro_factor_y", "gyro y white noise", "", factor<&NoiseAdjustment::gyro_factors, 1>, "the white noise of gyro y is"},
    {"gyro_factor_z", "gyro z white noise", "", factor<&NoiseAdjustment::gyro_factors, 2>, "the white noise of gyro z is"},
    {"accel_factor_x", "accelerometer x white noise", "", factor<&NoiseAdjustment::accel_factors, 0>,
     "the white noise of accelerometer x is"},
    {"accel_factor_y", "accelerometer y white noise", "", factor<&NoiseAdjustment::accel_factors, 1>,
     "the white noise of accelerometer y is"},
    {"accel_factor_z", "accelerometer z white noise", "", factor<&NoiseAdjustment::accel_factors, 2>,
     "the white noise of accelerometer z is"},
};

const FittedParameter* find(const std::string& name) {
  for (const FittedParameter& p : kParameters)
    if (name == p.name) return &p;
  return nullptr;
}

/// Within a factor of 2 a stated sigma is as good as usual.
std::string clause(const FittedParameter& parameter, double factor) {
  constexpr double kWorthSaying = 2.0;
  if (factor >= kWorthSaying) return fmt::format("{} {} times too small", parameter.subject, number(factor, 2));
  if (factor <= 1.0 / kWorthSaying) return fmt::format("{} {} times too large", parameter.subject, number(1.0 / factor, 2));
  return "";
}

}  // namespace

void add_noise_fit(const ProcessPage& page, report::Section& section) {
  if (!page.result.noise_fit) return;
  const estimate::NoiseFit& fit = *page.result.noise_fit;
  report::Table table;
  table.id = "noise-fit";
  table.title = "Noise found by the likelihood of the innovations";
  table.caption = fmt::format(
      "Already used in this run. A factor multiplies the stated standard deviation. Log-likelihood {:.1f} with the stated "
      "noise, "
      "{:.1f} with this one, over {} innovations.",
      fit.log_likelihood_before, fit.log_likelihood_after, fit.innovations);
  table.columns = {{"noise", "", false}, {"factor on stated", ""}, {"value", ""}, {"unit", "", false}, {"one sigma", "%"}};
  std::vector<std::string> clauses;
  for (std::size_t i = 0; i < fit.names.size(); ++i) {
    const FittedParameter* parameter = find(fit.names[i]);
    if (parameter == nullptr) continue;
    const double value = parameter->value(fit.adjustment);
    const bool is_factor = parameter->subject != nullptr;
    const bool known = i < fit.log_sd.size() && std::isfinite(fit.log_sd[i]);
    table.rows.push_back(cells({parameter->label, is_factor ? number(value) : "", is_factor ? "" : number(value),
                                parameter->unit, known ? number(100.0 * fit.log_sd[i], 2) : "not determined"}));
    if (!is_factor) continue;
    const std::string text = clause(*parameter, value);
    if (text.empty()) continue;
    table.rows.back()[1].verdict = report::Verdict::kWarn;
    clauses.push_back(text);
  }
  if (!clauses.empty())
    section.notes.push_back(
        {report::Note::Kind::kWarning, "", fmt::format("For this recording {}.", fmt::join(clauses, ", "))});
  section.tables.push_back(std::move(table));
}

}  // namespace coast::jobs
