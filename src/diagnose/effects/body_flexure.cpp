#include "effects.hpp"

namespace coast::diagnose {

Effect body_flexure() {
  return {
      .name = "body_flexure",
      .site = Site::kAntenna,
      .parameter = "compliance",
      .unit = "s^2",
      .equation = "d(r)_b,i = -k_i a_b,i: the antenna stays behind as the body accelerates",
      .meaning = "What carries the antenna bends under acceleration.",
      .sentence = "Under acceleration along {axis} the antenna lags behind the body by {size}.",
      .separating_manoeuvre = "Braking and turning hard; a smoothing receiver bends all axes alike and the other way.",
      .source = "static deflection m a / k",
      .axes = three_axes(),
      .plausible = {2e-3, 2e-3, 2e-3, 2e-3},
      .position =
          [](const FixSignals& s, Columns D) {
            const Eigen::Vector3d a_b = s.C_b_e.transpose() * s.a_ea_e;
            D = -s.C_b_e * a_b.asDiagonal();
          },
  };
}

}  // namespace coast::diagnose
