#include "effects.hpp"

namespace coast::diagnose {

Effect vehicle_mounting() {
  return {
      .name = "vehicle_mounting",
      .site = Site::kMount,
      .parameter = "angle",
      .unit = "rad",
      .equation = "the vehicle rolls along Rz(c_z + z) Ry(c_y + y) e_x, c the configured yaw and pitch",
      .meaning = "The vehicle does not roll where the configured mounting says it does.",
      .sentence = "The vehicle drives {size} off the configured mounting about {axis}.",
      .separating_manoeuvre = "None needed: speed shows it.",
      .source = "Groves (2013), section 15.4.1",
      .axes = {"y", "z"},
      .plausible = {0.05, 0.05, 0.05, 0.05},
      .slip =
          [](const WheelSignals& s, Eigen::Ref<Eigen::Matrix2Xd> D) {
            D = estimate::slip_by_mounting(s.constraint.pitch, s.constraint.yaw, s.u_b);
          },
      .configure =
          [](study::Setup& setup, const Eigen::VectorXd& value) {
            std::optional<estimate::NonHolonomic>& wheels = setup.filter.vehicle.non_holonomic;
            if (!wheels) return;
            wheels->pitch += value(0);
            wheels->yaw += value(1);
          },
  };
}

}  // namespace coast::diagnose
