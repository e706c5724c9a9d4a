#include "effects.hpp"

namespace coast::diagnose {

Effect rate_ramp_gyro() {
  return {
      .name = "rate_ramp",
      .site = Site::kGyro,
      .parameter = "slope",
      .unit = "rad/s^2",
      .equation = "d(omega)_i = R_i t",
      .meaning = "The bias grows steadily.",
      .sentence = "The bias of gyro {axis} grows by {size}.",
      .separating_manoeuvre = "A longer recording: a random walk turns, a ramp goes on.",
      .source = "IEEE Std 952-2020, rate ramp",
      .axes = three_axes(),
      .plausible = {1e-2 * kDegreePerHour / geo::kHour, 1.0 * kDegreePerHour / geo::kHour, 30.0 * kDegreePerHour / geo::kHour,
                    300.0 * kDegreePerHour / geo::kHour},
      .sensors = [](const Signals& s, SensorErrors& error) { error.gyro.diagonal().setConstant(s.elapsed); },
  };
}

Effect rate_ramp_accel() {
  return {
      .name = "rate_ramp",
      .site = Site::kAccel,
      .parameter = "slope",
      .unit = "m/s^3",
      .equation = "d(f)_i = R_i t",
      .meaning = "The bias grows steadily.",
      .sentence = "The bias of accelerometer {axis} grows by {size}.",
      .separating_manoeuvre = "A longer recording: a random walk turns, a ramp goes on.",
      .source = "IEEE Std 952-2020, rate ramp",
      .axes = three_axes(),
      .plausible = {1e-2 * kMilliG / geo::kHour, 0.1 * kMilliG / geo::kHour, 2.0 * kMilliG / geo::kHour,
                    10.0 * kMilliG / geo::kHour},
      .sensors = [](const Signals& s, SensorErrors& error) { error.accel.diagonal().setConstant(s.elapsed); },
  };
}

}  // namespace coast::diagnose
