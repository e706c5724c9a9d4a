#include "effects.hpp"

namespace coast::diagnose {

Effect accel_scale_factor() {
  return {
      .name = "accel_scale_factor",
      .site = Site::kAccel,
      .parameter = "scale",
      .unit = "1",
      .equation = "d(f)_i = S_i f_i",
      .meaning = "An accelerometer measures forces too large or too small by a constant share.",
      .sentence = "Accelerometer {axis} measures forces {size} too {way}.",
      .ways = {{"large", "small"}},
      .separating_manoeuvre = "Braking and accelerating hard; about the vertical, tilts of 30 degrees or vertical manoeuvres.",
      .source = "Groves (2013), section 4.4.2",
      .axes = three_axes(),
      .plausible = {5e-5, 3e-4, 3e-3, 1e-2},
      .sensors = [](const Signals& s, SensorErrors& error) { error.accel.diagonal() = s.f; },
  };
}

}  // namespace coast::diagnose
