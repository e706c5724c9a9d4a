#include "effects.hpp"

namespace coast::diagnose {

Effect gnss_smoothing_lag() {
  return {
      .name = "gnss_smoothing_lag",
      .site = Site::kGnss,
      .parameter = "lag_squared",
      .unit = "s^2",
      .equation = "r_a(t) + tau^2 a_a(t), what a first-order lag tau adds to a shift of the time by tau",
      .meaning = "The receiver smooths its positions: they cut corners and lag behind.",
      .sentence = "The receiver smooths its positions, with a time constant whose square is {size}.",
      .separating_manoeuvre = "Jerks: sharp braking and sharp turns; at constant acceleration it is a time offset.",
      .source = "first-order low-pass, expanded to the second order in tau",
      .axes = {""},
      .plausible = {0.02, 0.02, 0.02, 0.02},
      .position = [](const FixSignals& s, Columns D) { D.col(0) = s.a_ea_e; },
  };
}

}  // namespace coast::diagnose
