#include "effects.hpp"

namespace coast::diagnose {

Effect accel_misalignment() {
  return {
      .name = "accel_misalignment",
      .site = Site::kAccel,
      .parameter = "angle",
      .unit = "rad",
      .equation = "d(f)_i = M_ij f_j",
      .meaning = "An accelerometer feels a share of the force along another axis.",
      .sentence = "Accelerometer {axis} leans {way} axis {cause} by {size}.",
      .ways = {{"towards", "away from"}},
      .separating_manoeuvre = "Braking and turning separately; for the share of gravity, tilts or turns of the heading.",
      .source = "Groves (2013), section 4.4.2",
      .axes = six_pairs(),
      .plausible = {1e-4, 4e-4, 3e-3, 1e-2},
      .sensors =
          [](const Signals& s, SensorErrors& error) {
            for_each_pair(true, [&](auto column, auto response, auto cause) { error.accel(response, column) = s.f(cause); });
          },
  };
}

}  // namespace coast::diagnose
