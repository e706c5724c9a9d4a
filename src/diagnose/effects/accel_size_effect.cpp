#include "effects.hpp"

namespace coast::diagnose {

Effect accel_size_effect() {
  return {
      .name = "accel_size_effect",
      .site = Site::kAccel,
      .parameter = "distance",
      .unit = "m",
      .equation = "d(f)_i = u_i . (omega_dot x r_i + omega x (omega x r_i))",
      .meaning = "The three accelerometers do not sit at one point: each feels the rotation about its own.",
      .sentence = "Accelerometer {axis} sits {size} away from the point of reference along {cause}.",
      .separating_manoeuvre = "Fast turns about several axes; a shift common to all three is a lever arm.",
      .source = "Savage (1998), size effect",
      .axes = nine_pairs(),
      .plausible = {0.02, 0.02, 0.005, 0.002},
      .sensors =
          [](const Signals& s, SensorErrors& error) {
            const Eigen::Matrix3d turning = geo::skew(s.omega);
            const Eigen::Matrix3d moved = geo::skew(s.omega_dot) + turning * turning;
            for_each_pair(
                false, [&](auto column, auto response, auto cause) { error.accel(response, column) = moved(response, cause); });
          },
  };
}

}  // namespace coast::diagnose
