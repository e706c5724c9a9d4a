#include "lever_arm.hpp"

#include <fmt/format.h>

namespace coast::diagnose {

void lever_arm_position(const FixSignals& s, Columns D) {
  D = s.C_b_e;
}

void lever_arm_velocity(const FixSignals& s, Columns D) {
  D = s.C_b_e * geo::skew(s.omega_b);
}

Effect lever_arm_error() {
  return {
      .name = "lever_arm_error",
      .site = Site::kAntenna,
      .parameter = "distance",
      .unit = "m",
      .equation = "r_a = r_b + C_b_e (l + dl)",
      .meaning = "The antenna is not where the configuration puts it.",
      .sentence = "The antenna is {size} further {way} than stated.",
      .ways = {{"forward", "backward"}, {"right", "left"}, {"down", "up"}},
      .separating_manoeuvre = "Turns of both senses and speed changes; for the vertical component, roll and pitch.",
      .source = "Groves (2013), eq. (14.94)",
      .axes = three_axes(),
      .plausible = {0.1, 0.1, 0.1, 0.1},
      .position = lever_arm_position,
      .velocity = lever_arm_velocity,
      .configure = [](study::Setup& setup, const Eigen::VectorXd& value) { setup.lever_arm_b += value; },
      .key = RunKey{"imu", "lever_arm_m",
                    [](const study::Setup& setup) {
                      const Eigen::Vector3d& l = setup.lever_arm_b;
                      return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", l.x(), l.y(), l.z());
                    }},
  };
}

}  // namespace coast::diagnose
