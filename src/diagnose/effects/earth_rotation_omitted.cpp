#include "coast/geo/earth.hpp"
#include "effects.hpp"

namespace coast::diagnose {

Effect earth_rotation_omitted() {
  return {
      .name = "earth_rotation_omitted",
      .site = Site::kGyro,
      .parameter = "share",
      .unit = "1",
      .equation = "d(omega) = -c C_e_s omega_ie, c = 1 where the rotation of the Earth is missing",
      .meaning = "The gyros do not contain the rotation of the Earth, or contain it twice: somebody has taken it out already.",
      .sentence = "{size} of the rotation of the Earth is missing from the recorded rates.",
      .separating_manoeuvre = "Headings all round: a bias turns with the body.",
      .source = "Groves (2013), eq. (5.18)",
      .axes = {""},
      .plausible = {1.0, 1.0, 1.0, 1.0},
      .sensors = [](const Signals& s, SensorErrors& error) { error.gyro.col(0) = -geo::kEarthRate * s.C_e_s.col(2); },
  };
}

}  // namespace coast::diagnose
