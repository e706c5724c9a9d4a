#pragma once
// Numeric derivatives of a motion, and places on Earth where formulas like to fail.

#include <string>
#include <vector>

#include "coast/geo/units.hpp"
#include "coast/simulate/motions.hpp"

namespace coast::test {

/// First derivative by central differences of eighth order: truncation (omega h)^8 / 630 for a tone of omega.
template <typename Function>
[[nodiscard]] auto derivative(const Function& f, double t, double h) {
  using Value = decltype(f(t));
  const auto difference = [&](int i) -> Value { return f(t + i * h) - f(t - i * h); };
  return Value((0.8 * difference(1) - 0.2 * difference(2) + 4.0 / 105.0 * difference(3) - 1.0 / 280.0 * difference(4)) / h);
}

struct Place {
  std::string name;
  geo::Geodetic origin;
};

[[nodiscard]] inline std::vector<Place> places() {
  using geo::kDegree;
  return {{"lausanne", {46.52 * kDegree, 6.57 * kDegree, 400.0}},  {"date_line", {5.0 * kDegree, 179.9999 * kDegree, 10.0}},
          {"southern", {-33.9 * kDegree, -70.6 * kDegree, 520.0}}, {"north_pole", {90.0 * kDegree, 30.0 * kDegree, 2.0}},
          {"south_pole", {-89.9999 * kDegree, 0.0, 2800.0}},       {"equator", {0.0, 0.0, 0.0}}};
}

}  // namespace coast::test
