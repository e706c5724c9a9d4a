#include "effects.hpp"

namespace coast::diagnose {

Effect imu_clock_drift() {
  return {
      .name = "imu_clock_drift",
      .site = Site::kClock,
      .parameter = "drift",
      .unit = "1",
      .equation = "tag of the IMU = t + e t: fixes late by e t, rates and forces too small by e",
      .meaning = "The IMU's clock runs fast or slow against GPS time.",
      .separating_manoeuvre = "Minutes with speed changes: a constant offset does not grow.",
      .source = "Stebler et al. (2011), Time Synchronization",
      .axes = {""},
      .plausible = {1e-4, 1e-4, 1e-4, 1e-4},
      .position = [](const FixSignals& s, Columns D) { D.col(0) = -s.elapsed * s.v_ea_e; },
      .velocity = [](const FixSignals& s, Columns D) { D.col(0) = -s.elapsed * s.a_ea_e; },
  };
}

}  // namespace coast::diagnose
