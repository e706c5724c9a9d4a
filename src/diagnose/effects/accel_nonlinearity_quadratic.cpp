#include "effects.hpp"

namespace coast::diagnose {

Effect accel_nonlinearity_quadratic() {
  return {
      .name = "accel_nonlinearity_quadratic",
      .site = Site::kAccel,
      .parameter = "coefficient",
      .unit = "1/(m/s^2)",
      .equation = "d(f)_i = K2_i f_i^2",
      .meaning = "An accelerometer errs by the square of the force, whatever its sign.",
      .sentence = "Accelerometer {axis} errs by {size} times the square of the force.",
      .separating_manoeuvre = "Equal forces of both signs and of different sizes along that axis.",
      .source = "IEEE Std 1293-2018, K2",
      .axes = three_axes(),
      .plausible = {1e-5 / geo::kStandardGravity, 5e-5 / geo::kStandardGravity, 3e-4 / geo::kStandardGravity,
                    3e-3 / geo::kStandardGravity},
      .sensors = [](const Signals& s, SensorErrors& error) { error.accel.diagonal() = s.f.cwiseAbs2(); },
  };
}

}  // namespace coast::diagnose
