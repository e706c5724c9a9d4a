#include "effects.hpp"

namespace coast::diagnose {

Effect imu_clock_drift() {
  return {
      .name = "imu_clock_drift",
      .site = Site::kClock,
      .parameter = "drift",
      .unit = "1",
      .equation = "tag of the IMU = t + e t: in its time fixes come e t later, velocities are larger by e, d(f) = e (f + 2 g)",
      .meaning = "The IMU's clock runs fast or slow against GPS time.",
      .sentence = "The clock of the IMU runs {size} too {way}.",
      .ways = {{"fast", "slow"}},
      .separating_manoeuvre = "Minutes with speed changes: a constant offset does not grow.",
      .source = "Stebler et al. (2011), Time Synchronization",
      .axes = {""},
      .plausible = {1e-4, 1e-4, 1e-4, 1e-4},
      // In the time of the tags tau = (1 + e) t the body moves as y(tau) = x(t): y' = v (1 - e), y'' = a (1 - 2 e). Measured
      // is (a - g) (1 - e), while this motion requires y'' - g. Rates scale as y' and are consistent, except for the Earth's.
      .sensors =
          [](const Signals& s, SensorErrors& error) {
            error.accel.col(0) = s.f + 2.0 * geo::kStandardGravity * (s.C_e_s * s.C_n_e.col(2));
          },
      .position = [](const FixSignals& s, Columns D) { D.col(0) = s.elapsed * s.v_ea_e; },
      .velocity = [](const FixSignals& s, Columns D) { D.col(0) = s.elapsed * s.a_ea_e + s.v_ea_e; },
  };
}

}  // namespace coast::diagnose
