#include "effects.hpp"

namespace coast::diagnose {

Effect bias_step_gyro() {
  return {
      .name = "bias_step",
      .site = Site::kGyro,
      .begins = Effect::Begins::kAtSomeTime,
      .parameter = "step",
      .unit = "rad/s",
      .equation = "d(omega)_i = b_i from t0 on",
      .meaning = "The bias jumps and stays.",
      .sentence = "The bias of gyro {axis} jumped by {size}.",
      .separating_manoeuvre = "Minutes before and behind the jump with the speed changing.",
      .source = "de Jong & Penzer (1998)",
      .axes = three_axes(),
      .plausible = {0.1 * kDegreePerHour, 2.0 * kDegreePerHour, 50.0 * kDegreePerHour, 500.0 * kDegreePerHour},
      .sensors = [](const Signals&, SensorErrors& error) { error.gyro.diagonal().setOnes(); },
  };
}

Effect bias_step_accel() {
  return {
      .name = "bias_step",
      .site = Site::kAccel,
      .begins = Effect::Begins::kAtSomeTime,
      .parameter = "step",
      .unit = "m/s^2",
      .equation = "d(f)_i = b_i from t0 on",
      .meaning = "The bias jumps and stays.",
      .sentence = "The bias of accelerometer {axis} jumped by {size}.",
      .separating_manoeuvre = "Minutes before and behind the jump with the speed changing.",
      .source = "de Jong & Penzer (1998)",
      .axes = three_axes(),
      .plausible = {0.05 * kMilliG, 0.5 * kMilliG, 3.0 * kMilliG, 10.0 * kMilliG},
      .sensors = [](const Signals&, SensorErrors& error) { error.accel.diagonal().setOnes(); },
  };
}

}  // namespace coast::diagnose
