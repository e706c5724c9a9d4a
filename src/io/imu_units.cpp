#include "imu_units.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

/// Factor to SI from `units: {gyro: ..}` and `scale: {gyro: ..}`.
double factor(const std::optional<config::Node>& units, const std::optional<config::Node>& scale, std::string_view sensor,
              std::string_view default_unit, geo::Dimension dimension) {
  double to_si = 1.0;
  if (units) {
    const std::string name = units->text(sensor, default_unit);
    try {
      to_si = geo::to_si(1.0, name, dimension);
    } catch (const std::invalid_argument& e) {
      throw units->at(sensor).error(e.what(), fmt::format("a unit like {}", default_unit), "");
    }
  }
  if (scale) to_si *= scale->number(sensor, 1.0);
  return to_si;
}

}  // namespace

ImuFactors imu_factors(const config::Node& imu, bool increments) {
  using geo::Dimension;
  const auto units = imu.find("units");
  const auto scale = imu.find("scale");
  if (increments)
    return {factor(units, scale, "gyro", "rad", Dimension::kAngle), factor(units, scale, "accel", "m/s", Dimension::kVelocity)};
  return {factor(units, scale, "gyro", "rad/s", Dimension::kAngularRate),
          factor(units, scale, "accel", "m/s^2", Dimension::kSpecificForce)};
}

}  // namespace coast::io
