#include "effects.hpp"

namespace coast::diagnose {

Effect base_coordinate_offset() {
  return {
      .name = "base_coordinate_offset",
      .site = Site::kGnss,
      .parameter = "offset",
      .unit = "m",
      .equation = "d(r)_n = constant",
      .meaning = "The coordinates of the base are wrong, or in another frame or epoch.",
      .sentence = "The coordinates of the base are {size} too far {way}.",
      .ways = {{"north", "south"}, {"east", "west"}, {"down", "up"}},
      .separating_manoeuvre = "None: only a point or a trajectory known otherwise shows it.",
      .source = "the start has the same offset: no innovation changes",
      .axes = {"n", "e", "d"},
      .plausible = {1.0, 1.0, 1.0, 1.0},
      .needs_reference = true,
      .position = [](const FixSignals& s, Columns D) { D = s.C_n_e; },
  };
}

}  // namespace coast::diagnose
