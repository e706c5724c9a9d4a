#include "effects.hpp"

namespace coast::diagnose {

Effect accel_sign_asymmetric_scale() {
  return {
      .name = "accel_sign_asymmetric_scale",
      .site = Site::kAccel,
      .parameter = "scale",
      .unit = "1",
      .equation = "d(f)_i = Ka_i |f_i|",
      .meaning = "An accelerometer has another scale factor for pushing than for pulling.",
      .sentence = "Accelerometer {axis} errs by {size} of the size of the force, whatever its sign.",
      .separating_manoeuvre =
          "Forces of both signs and of very different sizes: against the square they differ by their curve alone.",
      .source = "IEEE Std 1293-2018, asymmetry",
      .axes = three_axes(),
      .plausible = {2e-5, 1e-4, 5e-4, 5e-3},
      .sensors = [](const Signals& s, SensorErrors& error) { error.accel.diagonal() = s.f.cwiseAbs(); },
  };
}

}  // namespace coast::diagnose
