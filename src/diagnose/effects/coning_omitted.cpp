#include "effects.hpp"

namespace coast::diagnose {

Effect coning_omitted() {
  return {
      .name = "coning_omitted",
      .site = Site::kGyro,
      .parameter = "share",
      .unit = "1",
      .equation = "d(omega) = -c (dtheta' x dtheta) / (12 dt), c = 1 where the increments lack their coning",
      .meaning = "Angles were summed up as if rotations commuted.",
      .sentence = "{size} of the coning correction is missing from the recorded angles.",
      .separating_manoeuvre = "Sustained angular vibration about two axes, and none.",
      .source = "Savage (1998), eq. (33)",
      .axes = {""},
      .plausible = {1.0, 1.0, 1.0, 1.0},
      .sensors = [](const Signals& s, SensorErrors& error) { error.gyro.col(0) = -s.coning; },
  };
}

}  // namespace coast::diagnose
