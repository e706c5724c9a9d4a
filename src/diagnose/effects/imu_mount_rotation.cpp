#include "effects.hpp"

namespace coast::diagnose {

Effect imu_mount_rotation() {
  return {
      .name = "imu_mount_rotation",
      .site = Site::kMount,
      .begins = Effect::Begins::kAtSomeTime,
      .parameter = "angle",
      .unit = "rad",
      .equation = "from t0 on d(omega) = -theta x omega, d(f) = -theta x f: both triads turned by theta",
      .meaning = "The IMU turns on its mount and stays turned.",
      .sentence = "The IMU turned on its mount by {size} about its axis {axis}.",
      .separating_manoeuvre = "Accelerations along known directions before and behind the slip.",
      .source = "small rotation of the sensor axes",
      .axes = three_axes(),
      .plausible = {0.01, 0.01, 0.01, 0.01},
      .sensors =
          [](const Signals& s, SensorErrors& error) {
            error.gyro = geo::skew(s.omega);
            error.accel = geo::skew(s.f);
          },
  };
}

}  // namespace coast::diagnose
