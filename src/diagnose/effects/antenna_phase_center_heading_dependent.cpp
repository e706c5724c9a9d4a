#include <cmath>

#include "effects.hpp"

namespace coast::diagnose {

Effect antenna_phase_center_heading_dependent() {
  return {
      .name = "antenna_phase_center_heading_dependent",
      .site = Site::kAntenna,
      .parameter = "amplitude",
      .unit = "m",
      .equation = "d(r)_D = a cos(heading) + b sin(heading)",
      .meaning = "The antenna's phase centre moves up and down with the heading.",
      .sentence = "With the heading the antenna's phase centre moves down by {size} times its {axis}.",
      .separating_manoeuvre = "All headings at constant speed, both ways round.",
      .source = "ANTEX 1.4: azimuth-dependent phase-centre variations",
      .axes = {"cos", "sin"},
      .plausible = {0.01, 0.01, 0.01, 0.01},
      .position =
          [](const FixSignals& s, Columns D) {
            D.col(0) = std::cos(s.heading()) * s.C_n_e.col(2);
            D.col(1) = std::sin(s.heading()) * s.C_n_e.col(2);
          },
  };
}

}  // namespace coast::diagnose
