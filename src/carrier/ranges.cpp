#include "coast/carrier/ranges.hpp"

#include <cmath>

#include "coast/carrier/signals.hpp"
#include "coast/carrier/surface_weather.hpp"

namespace coast::carrier {

std::optional<SatelliteState> at_transmission(const Orbits& orbits, record::Satellite satellite, geo::GpsTime t,
                                              double pseudorange) {
  const geo::GpsTime shown = t - pseudorange / kSpeedOfLight;
  const std::optional<SatelliteState> rough = orbits.at(satellite, shown);
  if (!rough) return std::nullopt;
  return orbits.at(satellite, shown - rough->clock_s);
}

double SignalPath::modelled(const SatelliteState& satellite) const {
  return range - kSpeedOfLight * satellite.clock_s + troposphere;
}

SignalPath path_to(const SatelliteState& satellite, const Eigen::Vector3d& r_receiver_e, const geo::Geodetic& receiver,
                   geo::GpsTime t, bool troposphere) {
  constexpr double kLowest = 1.0 / 57.29577951308232;
  // The ECEF axes of reception have rotated by omega tau relative to those of transmission; tau to 1e-9 is accurate to 1 um.
  double range = (satellite.r_e - r_receiver_e).norm();
  Eigen::Vector3d r_satellite_e;
  for (int i = 0; i < 2; ++i) {
    const double angle = geo::kEarthRate * range / kSpeedOfLight;
    const double c = std::cos(angle), s = std::sin(angle);
    r_satellite_e = {c * satellite.r_e.x() + s * satellite.r_e.y(), c * satellite.r_e.y() - s * satellite.r_e.x(),
                     satellite.r_e.z()};
    range = (r_satellite_e - r_receiver_e).norm();
  }
  SignalPath path;
  path.range = range;
  path.to_satellite_e = (r_satellite_e - r_receiver_e) / range;
  path.direction = direction_of(r_satellite_e, r_receiver_e);
  if (!troposphere || path.direction.elevation < kLowest) return path;
  const ZenithDelay zenith = zenith_delay(surface_weather(receiver, t), receiver);
  const TroposphericMapping mapping = niell_mapping(receiver, path.direction.elevation, t);
  path.troposphere = mapping.hydrostatic * zenith.hydrostatic + mapping.wet * zenith.wet;
  path.wet_mapping = mapping.wet;
  return path;
}

double modelled_rate(const SatelliteState& satellite, const Eigen::Vector3d& r_receiver_e,
                     const Eigen::Vector3d& v_receiver_e) {
  const Eigen::Vector3d to_satellite_e = (satellite.r_e - r_receiver_e).normalized();
  const double sagnac = geo::kEarthRate / kSpeedOfLight *
                        (satellite.v_e.x() * r_receiver_e.y() - satellite.v_e.y() * r_receiver_e.x() +
                         satellite.r_e.x() * v_receiver_e.y() - satellite.r_e.y() * v_receiver_e.x());
  return to_satellite_e.dot(satellite.v_e - v_receiver_e) + sagnac - kSpeedOfLight * satellite.clock_rate;
}

}  // namespace coast::carrier
