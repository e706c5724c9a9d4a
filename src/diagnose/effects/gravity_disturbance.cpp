#include "effects.hpp"

namespace coast::diagnose {

Effect gravity_disturbance() {
  return {
      .name = "gravity_disturbance",
      .site = Site::kGravity,
      .parameter = "disturbance",
      .unit = "m/s^2",
      .equation = "d(f)_n = -dg_n: gravity is normal gravity + dg",
      .meaning = "Gravity is not that of the ellipsoid: deflection of the vertical and gravity anomaly.",
      .sentence = "Gravity pulls {size} further {way} than the ellipsoid's.",
      .ways = {{"north", "south"}, {"east", "west"}, {"down", "up"}},
      .separating_manoeuvre =
          "Headings all round: a bias turns with the body, gravity does not; the vertical part needs other heights or tilts.",
      .source = "Groves (2013), section 2.4.7",
      .axes = {"n", "e", "d"},
      .plausible = {50.0 * geo::kMilliGal, 50.0 * geo::kMilliGal, 50.0 * geo::kMilliGal, 50.0 * geo::kMilliGal},
      .sensors = [](const Signals& s, SensorErrors& error) { error.accel = -s.C_e_s * s.C_n_e; },
  };
}

}  // namespace coast::diagnose
