#include "effects.hpp"

namespace coast::diagnose {

Effect gnss_wrong_fix() {
  return {
      .name = "gnss_wrong_fix",
      .site = Site::kGnss,
      .begins = Effect::Begins::kAtSomeTime,
      .parameter = "offset",
      .unit = "m",
      .equation = "d(r)_n = constant from t0 to t1",
      .meaning = "Integers were fixed wrongly for a while: positions are shifted with small sigmas.",
      .sentence = "The fixes are {size} too far {way}.",
      .ways = {{"north", "south"}, {"east", "west"}, {"down", "up"}},
      .sentence_of_many = "The fixes are wrong {times}, by up to {size}.",
      .separating_manoeuvre = "None needed: entry and exit are jumps that no vehicle makes.",
      .source = "de Jong & Penzer (1998)",
      .axes = {"n", "e", "d"},
      .plausible = {0.5, 0.5, 0.5, 0.5},
      .position = [](const FixSignals& s, Columns D) { D = s.C_n_e; },
  };
}

}  // namespace coast::diagnose
