#include "effects.hpp"

namespace coast::diagnose {

Effect gyro_g_sensitivity() {
  return {
      .name = "gyro_g_sensitivity",
      .site = Site::kGyro,
      .parameter = "coefficient",
      .unit = "rad/s/(m/s^2)",
      .equation = "d(omega)_i = G_ij f_j",
      .meaning = "A gyro answers to acceleration as if it were a rotation.",
      .sentence = "Gyro {axis} answers to forces along {cause} with {size}.",
      .separating_manoeuvre = "Braking and accelerating on a straight; the share of gravity shows in tilts alone.",
      .source = "Groves (2013), section 4.4.4",
      .axes = nine_pairs(),
      .plausible = {1e-2 * kDegreePerHour / geo::kStandardGravity, kDegreePerHour / geo::kStandardGravity,
                    40.0 * kDegreePerHour / geo::kStandardGravity, 300.0 * kDegreePerHour / geo::kStandardGravity},
      .sensors =
          [](const Signals& s, SensorErrors& error) {
            for_each_pair(false, [&](auto column, auto response, auto cause) { error.gyro(response, column) = s.f(cause); });
          },
  };
}

}  // namespace coast::diagnose
