#include <utility>

#include "coast/carrier/orbits.hpp"
#include "coast/carrier/signals.hpp"
#include "coast/carrier/solid_tides.hpp"

namespace coast::carrier {

namespace {

/// The phase centre to which clocks refer, from those of two bands: of the ionosphere-free combination.
std::optional<Eigen::Vector3d> ionosphere_free_offset(const record::AntennaCalibration& antenna,
                                                      record::SatelliteSystem system) {
  std::optional<std::pair<double, Eigen::Vector3d>> first;
  for (const auto& [band, centre] : antenna.bands) {
    const auto f = carrier_frequency(system, band.second);
    if (!f || band.first != system) continue;
    const double squared = 1.0 / (*f * *f);
    if (!first) {
      first = {squared, centre.offset};
      continue;
    }
    const double a = squared / (squared - first->first);
    return a * first->second + (1.0 - a) * centre.offset;
  }
  return first ? std::optional(first->second) : std::nullopt;
}

}  // namespace

Eigen::Matrix3d yaw_steering_axes(const Eigen::Vector3d& r_satellite_e, const Eigen::Vector3d& r_sun_e) {
  Eigen::Matrix3d axes;
  axes.col(2) = -r_satellite_e.normalized();
  axes.col(1) = axes.col(2).cross((r_sun_e - r_satellite_e).normalized()).normalized();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  return axes;
}

PhaseCentredOrbits::PhaseCentredOrbits(const Orbits& centres_of_mass, const record::AntennaTable& table)
    : centres_of_mass_(centres_of_mass) {
  for (const record::AntennaCalibration& antenna : table.antennas)
    if (antenna.satellite)
      if (const auto offset = ionosphere_free_offset(antenna, antenna.satellite->system))
        offsets_[*antenna.satellite].push_back({antenna.from, antenna.until, *offset});
}

std::optional<SatelliteState> PhaseCentredOrbits::at(record::Satellite satellite, geo::GpsTime t) const {
  std::optional<SatelliteState> state = centres_of_mass_.at(satellite, t);
  const auto found = offsets_.find(satellite);
  if (!state || found == offsets_.end()) return state;
  for (const Offset& o : found->second)
    if ((!o.from || *o.from <= t) && (!o.until || t <= *o.until)) {
      state->r_e += yaw_steering_axes(state->r_e, sun_e(t)) * o.value;
      break;
    }
  return state;
}

}  // namespace coast::carrier
