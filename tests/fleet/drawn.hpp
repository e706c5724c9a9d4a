#pragma once
// Fleets that are drawn: known scatter, and what a test adds.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "coast/fleet/estimates.hpp"

namespace coast::test {

/// Twelve units with 15 missions each in two years, three figures, temperatures of the season, scatter 2 and sigmas about 1.
inline fleet::Fleet drawn_fleet(std::uint64_t seed, int units = 12, int missions = 15) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  fleet::Fleet all;
  for (const char* axis : {"x", "y", "z"}) all.panels.push_back({"gyro_bias", axis, "rad/s", {}});
  for (int u = 0; u < units; ++u) {
    std::vector<double> dates(static_cast<std::size_t>(missions));
    for (double& t : dates) t = 2.0 * uniform(random);
    std::sort(dates.begin(), dates.end());
    for (fleet::Panel& panel : all.panels) {
      fleet::Series& series = panel.series.emplace_back();
      series.unit = fmt::format("u{}", u);
      const double level = 20.0 * normal(random);
      for (std::size_t m = 0; m < dates.size(); ++m) {
        fleet::Estimate e;
        e.mission = fmt::format("{}-{}", series.unit, m);
        e.t = dates[m];
        e.sigma = std::exp(0.4 * normal(random));
        e.temperature = 12.0 - 10.0 * std::cos(2.0 * 3.14159265358979 * e.t) + 4.0 * normal(random);
        e.value = level + 2.0 * normal(random) + e.sigma * normal(random);
        series.estimates.push_back(e);
      }
    }
  }
  return all;
}

}  // namespace coast::test
