#include "time_offset.hpp"

#include <fmt/format.h>

namespace coast::diagnose {

void time_offset_position(const FixSignals& s, Columns D) {
  D.col(0) = -s.v_ea_e;
}

void time_offset_velocity(const FixSignals& s, Columns D) {
  D.col(0) = -s.a_ea_e;
}

Effect gnss_time_offset() {
  return {
      .name = "gnss_time_offset",
      .site = Site::kClock,
      .parameter = "offset",
      .unit = "s",
      .equation = "a fix tagged t is valid at t - d: r_a(t) - v_a d",
      .meaning = "GNSS and IMU do not agree about the time.",
      .sentence = "The fixes are valid {size} {way} than their tags say.",
      .ways = {{"earlier", "later"}},
      .separating_manoeuvre = "Speed changes on a straight; a lever arm forward looks the same at constant speed.",
      .source = "Skog & Haendel (2011)",
      .axes = {""},
      .plausible = {0.02, 0.02, 0.02, 0.02},
      .position = time_offset_position,
      .velocity = time_offset_velocity,
      .configure = [](study::Setup& setup, const Eigen::VectorXd& value) { setup.time_offset_s += value(0); },
      .key =
          RunKey{"gnss", "time_offset_s", [](const study::Setup& setup) { return fmt::format("{:.5f}", setup.time_offset_s); }},
  };
}

}  // namespace coast::diagnose
