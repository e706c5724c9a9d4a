#include "effects.hpp"

namespace coast::diagnose {

Effect gyro_g2_sensitivity() {
  return {
      .name = "gyro_g2_sensitivity",
      .site = Site::kGyro,
      .parameter = "coefficient",
      .unit = "rad/s/(m/s^2)^2",
      .equation = "d(omega)_i = G2_ij f_j^2",
      .meaning = "A gyro answers to the square of a force, whatever its sign: anisoelasticity.",
      .sentence = "Gyro {axis} answers to the square of forces along {cause} with {size}.",
      .separating_manoeuvre = "Equal forces of both signs along that axis.",
      .source = "Titterton & Weston (2004), section 4.8",
      .axes = nine_pairs(),
      .plausible = {1e-3 * kDegreePerHour / 96.2, 0.1 * kDegreePerHour / 96.2, 10.0 * kDegreePerHour / 96.2,
                    20.0 * kDegreePerHour / 96.2},
      .sensors =
          [](const Signals& s, SensorErrors& error) {
            for_each_pair(
                false, [&](auto column, auto response, auto cause) { error.gyro(response, column) = s.f(cause) * s.f(cause); });
          },
  };
}

}  // namespace coast::diagnose
