#include "time_offset.hpp"

namespace coast::diagnose {

Effect imu_timestamp_gap() {
  return {
      .name = "imu_timestamp_gap",
      .site = Site::kClock,
      .begins = Effect::Begins::kAtSomeTime,
      .lasting = "gnss_time_offset",
      .parameter = "offset",
      .unit = "s",
      .equation = "from t0 on a fix tagged t is valid at t - d",
      .meaning =
          "From some instant on the tags of IMU and GNSS are shifted against each other: samples were lost, or counted twice.",
      .sentence = "The fixes are valid {size} {way} against the IMU than before.",
      .ways = {{"earlier", "later"}},
      .separating_manoeuvre = "Speed changes before and behind the gap.",
      .source = "de Jong & Penzer (1998)",
      .axes = {""},
      .plausible = {0.02, 0.02, 0.02, 0.02},
      .position = time_offset_position,
      .velocity = time_offset_velocity,
  };
}

}  // namespace coast::diagnose
