#include "lever_arm.hpp"

namespace coast::diagnose {

Effect antenna_mount_slip() {
  return {
      .name = "antenna_mount_slip",
      .site = Site::kAntenna,
      .begins = Effect::Begins::kAtSomeTime,
      .lasting = "lever_arm_error",
      .parameter = "distance",
      .unit = "m",
      .equation = "r_a = r_b + C_b_e (l + dl)",
      .meaning = "The antenna moves on the vehicle and stays at its new place.",
      .sentence = "The antenna moved {size} {way}.",
      .ways = {{"forward", "backward"}, {"right", "left"}, {"down", "up"}},
      .separating_manoeuvre = "Turns before and behind the slip.",
      .source = "de Jong & Penzer (1998)",
      .axes = three_axes(),
      .plausible = {0.03, 0.03, 0.03, 0.03},
      .position = lever_arm_position,
      .velocity = lever_arm_velocity,
  };
}

}  // namespace coast::diagnose
