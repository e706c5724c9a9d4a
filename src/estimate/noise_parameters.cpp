#include "noise_parameters.hpp"

namespace coast::estimate {

namespace {

template <auto Factors, Eigen::Index Axis>
double& factor(NoiseAdjustment& adjustment) {
  return (adjustment.*Factors)(Axis);
}

}  // namespace

std::vector<NoiseParameter> free_parameters(const NoiseFitChoice& choice, bool velocities) {
  using Adjustment = NoiseAdjustment;
  std::vector<NoiseParameter> p;
  const auto add = [&](NoisePart part, const char* name, double& (*value)(Adjustment&), double low, double high) {
    p.push_back({part, name, value, low, high});
  };
  if (choice.gnss_scale) {
    constexpr double kLow = 0.005, kHigh = 100.0;
    add(
        NoisePart::kScaleHorizontal, "gnss_scale_horizontal", [](Adjustment& a) -> double& { return a.gnss_scale.horizontal; },
        kLow, kHigh);
    add(
        NoisePart::kScaleVertical, "gnss_scale_vertical", [](Adjustment& a) -> double& { return a.gnss_scale.vertical; }, kLow,
        kHigh);
    if (velocities)
      add(
          NoisePart::kScaleVelocity, "gnss_scale_velocity", [](Adjustment& a) -> double& { return a.gnss_scale.velocity; },
          kLow, kHigh);
  }
  if (choice.correlated_gnss) {
    constexpr double kLow = 1e-4, kHigh = 20.0;  // m
    add(
        NoisePart::kCorrelatedHorizontal, "correlated_horizontal_m",
        [](Adjustment& a) -> double& { return a.correlated_gnss.horizontal_m; }, kLow, kHigh);
    add(
        NoisePart::kCorrelatedVertical, "correlated_vertical_m",
        [](Adjustment& a) -> double& { return a.correlated_gnss.vertical_m; }, kLow, kHigh);
    add(
        NoisePart::kCorrelatedTime, "correlated_time_s", [](Adjustment& a) -> double& { return a.correlated_gnss.time_s; }, 1.0,
        600.0);
  }
  if (choice.imu_white_noise) {
    constexpr double kLow = 0.05, kHigh = 1000.0;
    add(NoisePart::kGyroX, "gyro_factor_x", factor<&Adjustment::gyro_factors, 0>, kLow, kHigh);
    add(NoisePart::kGyroY, "gyro_factor_y", factor<&Adjustment::gyro_factors, 1>, kLow, kHigh);
    add(NoisePart::kGyroZ, "gyro_factor_z", factor<&Adjustment::gyro_factors, 2>, kLow, kHigh);
    add(NoisePart::kAccelX, "accel_factor_x", factor<&Adjustment::accel_factors, 0>, kLow, kHigh);
    add(NoisePart::kAccelY, "accel_factor_y", factor<&Adjustment::accel_factors, 1>, kLow, kHigh);
    add(NoisePart::kAccelZ, "accel_factor_z", factor<&Adjustment::accel_factors, 2>, kLow, kHigh);
  }
  return p;
}

}  // namespace coast::estimate
