#include "effects.hpp"

namespace coast::diagnose {

Effect gyro_scale_factor() {
  return {
      .name = "gyro_scale_factor",
      .site = Site::kGyro,
      .parameter = "scale",
      .unit = "1",
      .equation = "d(omega)_i = S_i omega_i",
      .meaning = "A gyro measures turns too long or too short by a constant share.",
      .sentence = "Gyro {axis} measures rotations {size} too {way}.",
      .ways = {{"large", "small"}},
      .separating_manoeuvre = "Turns of both senses about that axis, at different speeds.",
      .source = "Groves (2013), section 4.4.2",
      .axes = three_axes(),
      .plausible = {1e-5, 2e-4, 2e-3, 1e-2},
      .sensors = [](const Signals& s, SensorErrors& error) { error.gyro.diagonal() = s.omega; },
  };
}

}  // namespace coast::diagnose
