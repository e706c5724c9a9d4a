#include "coast/study/drift.hpp"

#include <cmath>

#include "coast/study/paired.hpp"

namespace coast::study {

std::vector<double> drifts(std::span<const OutageResult> outages, DriftMeasure measure, bool smoothed) {
  std::vector<double> values;
  for (const OutageResult& outage : outages) {
    const OutageErrors& errors = smoothed ? *outage.smoothed : outage.forward;
    values.push_back(measure == DriftMeasure::kHorizontal ? errors.horizontal_max_m
                                                          : errors.max_m(static_cast<Eigen::Index>(measure)));
  }
  return values;
}

Spread spread_of(const std::vector<double>& absolute_errors) {
  double square = 0.0;
  for (const double error : absolute_errors) square += error * error;
  return {quantile(absolute_errors, 0.5), quantile(absolute_errors, 0.68), quantile(absolute_errors, 0.95),
          quantile(absolute_errors, 1.0), std::sqrt(square / static_cast<double>(absolute_errors.size()))};
}

Drift drift_of(std::span<const OutageResult> outages, bool smoothed) {
  Drift drift;
  double inside = 0.0;
  double tested = 0.0;
  std::array<std::vector<double>, 3> end;
  std::vector<double> against_gnss;
  const auto count = static_cast<double>(outages.size());
  for (const OutageResult& outage : outages) {
    const OutageErrors& errors = smoothed ? *outage.smoothed : outage.forward;
    for (Eigen::Index axis = 0; axis < 3; ++axis) end[static_cast<std::size_t>(axis)].push_back(std::abs(errors.end_m(axis)));
    drift.predicted_end_rms_m += errors.sigma_end_m.cwiseAbs2() / count;
    drift.predicted_largest_rms_m += errors.sigma_max_m.cwiseAbs2() / count;
    inside += static_cast<double>(errors.inside_95);
    tested += static_cast<double>(errors.tested);
    if (errors.gnss_horizontal_max_m) against_gnss.push_back(*errors.gnss_horizontal_max_m);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    drift.largest[axis] = spread_of(drifts(outages, static_cast<DriftMeasure>(axis), smoothed));
    drift.end[axis] = spread_of(end[axis]);
  }
  drift.predicted_end_rms_m = drift.predicted_end_rms_m.cwiseSqrt();
  drift.predicted_largest_rms_m = drift.predicted_largest_rms_m.cwiseSqrt();
  drift.horizontal = spread_of(drifts(outages, DriftMeasure::kHorizontal, smoothed));
  if (tested > 0.0) drift.inside_95 = inside / tested;
  if (!against_gnss.empty()) drift.against_gnss = spread_of(against_gnss);
  return drift;
}

double gyro_noise_drift(geo::Psd gyro_density, double duration_s) {
  constexpr double kGravity = 9.80665;  // m/s^2; two digits of the drift are sufficient
  return kGravity * std::sqrt(gyro_density.value * std::pow(duration_s, 5) / 20.0);
}

}  // namespace coast::study
