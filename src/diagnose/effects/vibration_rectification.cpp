#include "effects.hpp"

namespace coast::diagnose {

Effect vibration_rectification() {
  return {
      .name = "vibration_rectification",
      .site = Site::kAccel,
      .parameter = "coefficient",
      .unit = "1/(m/s^2)",
      .equation = "d(f)_i = k_i var(f_i), variance of the vibration",
      .meaning = "Vibration shifts the bias of an accelerometer.",
      .sentence = "Vibration shifts the bias of accelerometer {axis} by {size} times its variance.",
      .separating_manoeuvre = "Rough and smooth ground at the same speed; the engine on and off at rest.",
      .source = "IEEE Std 1293-2018, vibration rectification",
      .axes = three_axes(),
      .plausible = {1e-5 / geo::kStandardGravity, 5e-5 / geo::kStandardGravity, 1e-3 / geo::kStandardGravity,
                    5e-3 / geo::kStandardGravity},
      .sensors = [](const Signals& s, SensorErrors& error) { error.accel.diagonal() = s.vibration; },
  };
}

}  // namespace coast::diagnose
