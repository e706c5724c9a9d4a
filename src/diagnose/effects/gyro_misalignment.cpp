#include "effects.hpp"

namespace coast::diagnose {

Effect gyro_misalignment() {
  return {
      .name = "gyro_misalignment",
      .site = Site::kGyro,
      .parameter = "angle",
      .unit = "rad",
      .equation = "d(omega)_i = M_ij omega_j",
      .meaning = "A gyro feels a share of the rotation about another axis: its sensitive axis is not where it should be.",
      .sentence = "Gyro {axis} leans {way} axis {cause} by {size}.",
      .ways = {{"towards", "away from"}},
      .separating_manoeuvre = "Rotations about one axis at a time: roll and pitch beside yaw.",
      .source = "Groves (2013), section 4.4.2",
      .axes = six_pairs(),
      .plausible = {1e-4, 4e-4, 3e-3, 1e-2},
      .sensors =
          [](const Signals& s, SensorErrors& error) {
            for_each_pair(true, [&](auto column, auto response, auto cause) { error.gyro(response, column) = s.omega(cause); });
          },
  };
}

}  // namespace coast::diagnose
