#include "coast/geo/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "coast/geo/nearest_word.hpp"

namespace coast::geo {

namespace {

constexpr double kSqrtHour = 60.0;  // sqrt(3600 s), sqrt(s)
constexpr double kG = kStandardGravity;
constexpr double kMicroG = 1e-6 * kG;
constexpr double kPpm = 1e-6;

// Celsius differences are kelvins, so only the 1/K forms exist.
constexpr Unit kUnits[] = {
    {"rad/s/sqrt(Hz)", 1.0, Dimension::kAngularRateNoise},
    {"deg/sqrt(h)", kDegree / kSqrtHour, Dimension::kAngularRateNoise},
    {"deg/s/sqrt(Hz)", kDegree, Dimension::kAngularRateNoise},
    {"deg/h/sqrt(Hz)", kDegree / kHour, Dimension::kAngularRateNoise},
    {"m/s^2/sqrt(Hz)", 1.0, Dimension::kSpecificForceNoise},
    {"m/s/sqrt(h)", 1.0 / kSqrtHour, Dimension::kSpecificForceNoise},
    {"ug/sqrt(Hz)", kMicroG, Dimension::kSpecificForceNoise},
    {"rad/s", 1.0, Dimension::kAngularRate},
    {"deg/s", kDegree, Dimension::kAngularRate},
    {"dps", kDegree, Dimension::kAngularRate},
    {"deg/h", kDegree / kHour, Dimension::kAngularRate},
    {"m/s^2", 1.0, Dimension::kSpecificForce},
    {"g", kG, Dimension::kSpecificForce},
    {"mg", 1e-3 * kG, Dimension::kSpecificForce},
    {"ug", kMicroG, Dimension::kSpecificForce},
    {"mGal", kMilliGal, Dimension::kSpecificForce},
    {"(m/s^2)^2", 1.0, Dimension::kSpecificForceVariance},
    {"(rad/s)^2", 1.0, Dimension::kAngularRateVariance},
    {"rad/s/sqrt(s)", 1.0, Dimension::kAngularRateWalk},
    {"deg/h/sqrt(h)", kDegree / kHour / kSqrtHour, Dimension::kAngularRateWalk},
    {"deg/s/sqrt(s)", kDegree, Dimension::kAngularRateWalk},
    {"m/s^2/sqrt(s)", 1.0, Dimension::kSpecificForceWalk},
    {"ug/sqrt(s)", kMicroG, Dimension::kSpecificForceWalk},
    {"rad/s^2", 1.0, Dimension::kAngularRateRamp},
    {"deg/h/h", kDegree / kHour / kHour, Dimension::kAngularRateRamp},
    {"m/s^3", 1.0, Dimension::kSpecificForceRamp},
    {"ug/h", kMicroG / kHour, Dimension::kSpecificForceRamp},
    {"rad", 1.0, Dimension::kAngle},
    {"mrad", 1e-3, Dimension::kAngle},
    {"deg", kDegree, Dimension::kAngle},
    {"mdeg", 1e-3 * kDegree, Dimension::kAngle},
    {"arcsec", kArcMinute / 60.0, Dimension::kAngle},
    {"1", 1.0, Dimension::kRatio},
    {"ppm", kPpm, Dimension::kRatio},
    {"1/K", 1.0, Dimension::kRatioPerKelvin},
    {"ppm/K", kPpm, Dimension::kRatioPerKelvin},
    {"rad/s/K", 1.0, Dimension::kAngularRatePerKelvin},
    {"deg/s/K", kDegree, Dimension::kAngularRatePerKelvin},
    {"deg/h/K", kDegree / kHour, Dimension::kAngularRatePerKelvin},
    {"m/s^2/K", 1.0, Dimension::kSpecificForcePerKelvin},
    {"mg/K", 1e-3 * kG, Dimension::kSpecificForcePerKelvin},
    {"ug/K", kMicroG, Dimension::kSpecificForcePerKelvin},
    {"rad/s/(m/s^2)", 1.0, Dimension::kAngularRatePerForce},
    {"deg/s/g", kDegree / kG, Dimension::kAngularRatePerForce},
    {"deg/h/g", kDegree / kHour / kG, Dimension::kAngularRatePerForce},
    {"1/(m/s^2)", 1.0, Dimension::kPerForce},
    {"ug/g^2", kMicroG / (kG * kG), Dimension::kPerForce},
    {"m/s", 1.0, Dimension::kVelocity},
    {"m", 1.0, Dimension::kLength},
    {"mm", 1e-3, Dimension::kLength},
    {"s", 1.0, Dimension::kTime},
    {"ms", 1e-3, Dimension::kTime},
    {"h", kHour, Dimension::kTime},
};

std::string names_of(Dimension dimension) {
  std::string list;
  for (const Unit& u : kUnits) {
    if (u.dimension != dimension) continue;
    if (!list.empty()) list += ", ";
    list += u.name;
  }
  return list;
}

}  // namespace

const std::vector<Unit>& units() {
  static const std::vector<Unit> table(std::begin(kUnits), std::end(kUnits));
  return table;
}

const Unit& unit(std::string_view name) {
  const auto found = std::find_if(std::begin(kUnits), std::end(kUnits), [name](const Unit& u) { return u.name == name; });
  if (found != std::end(kUnits)) return *found;
  std::vector<std::string> known;
  for (const Unit& u : kUnits) known.emplace_back(u.name);
  const std::string nearest = nearest_word(name, known);
  throw std::invalid_argument(nearest.empty() ? fmt::format("unknown unit '{}'", name)
                                              : fmt::format("unknown unit '{}', the nearest known is '{}'", name, nearest));
}

double to_si(double value, std::string_view name, Dimension dimension) {
  const Unit& u = unit(name);
  if (u.dimension != dimension) {
    throw std::invalid_argument(fmt::format("unit '{}' does not fit here, expected one of {}", name, names_of(dimension)));
  }
  return value * u.to_si;
}

}  // namespace coast::geo
