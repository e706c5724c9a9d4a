#include "effects.hpp"

namespace coast::diagnose {

Effect temperature_rate_hysteresis_gyro() {
  return {
      .name = "temperature_rate_hysteresis",
      .site = Site::kGyro,
      .parameter = "coefficient",
      .unit = "rad/s/(K/s)",
      .equation = "d(omega)_i = k_i dT/dt",
      .meaning = "The bias depends on whether the sensor is being warmed or cooled.",
      .sentence = "While it warms the bias of gyro {axis} is larger by {size}.",
      .separating_manoeuvre = "Warming and cooling through the same temperatures.",
      .source = "Shupe (1980)",
      .axes = three_axes(),
      .plausible = {0.1 * kDegreePerHour * 60.0, 1.0 * kDegreePerHour * 60.0, 20.0 * kDegreePerHour * 60.0,
                    200.0 * kDegreePerHour * 60.0},
      .needs_temperature = true,
      .sensors = [](const Signals& s, SensorErrors& error) { error.gyro.diagonal().setConstant(s.temperature_rate); },
  };
}

Effect temperature_rate_hysteresis_accel() {
  return {
      .name = "temperature_rate_hysteresis",
      .site = Site::kAccel,
      .parameter = "coefficient",
      .unit = "m/s^2/(K/s)",
      .equation = "d(f)_i = k_i dT/dt",
      .meaning = "The bias depends on whether the sensor is being warmed or cooled.",
      .sentence = "While it warms the bias of accelerometer {axis} is larger by {size}.",
      .separating_manoeuvre = "Warming and cooling through the same temperatures.",
      .source = "Shupe (1980)",
      .axes = three_axes(),
      .plausible = {1e-2 * kMilliG * 60.0, 0.1 * kMilliG * 60.0, 1.0 * kMilliG * 60.0, 5.0 * kMilliG * 60.0},
      .needs_temperature = true,
      .sensors = [](const Signals& s, SensorErrors& error) { error.accel.diagonal().setConstant(s.temperature_rate); },
  };
}

}  // namespace coast::diagnose
