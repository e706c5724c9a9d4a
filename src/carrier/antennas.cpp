#include "coast/carrier/antennas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coast/carrier/signals.hpp"

namespace coast::carrier {

namespace {

using record::PhaseCentre;
using record::SatelliteSystem;

/// Calibration of the band, or of the nearest frequency of GPS.
const PhaseCentre* centre_of(const record::AntennaCalibration& antenna, SatelliteSystem system, char band) {
  const auto own = antenna.bands.find({system, band});
  if (own != antenna.bands.end()) return &own->second;
  const double wanted = carrier_frequency(system, band).value_or(kL1Frequency);
  const PhaseCentre* nearest = nullptr;
  double least = 0.0;
  for (const auto& [signal, centre] : antenna.bands) {
    const auto frequency =
        signal.first == SatelliteSystem::kGps ? carrier_frequency(signal.first, signal.second) : std::nullopt;
    if (!frequency) continue;
    const double off = std::abs(*frequency - wanted);
    if (nearest != nullptr && off >= least) continue;
    nearest = &centre;
    least = off;
  }
  return nearest;
}

/// Position of a value between the rows or columns of a table.
struct Between {
  std::size_t first = 0, second = 0;
  double weight = 0.0;  ///< of the second
};

Between between(double position, std::size_t count) {
  const double clamped = std::clamp(position, 0.0, static_cast<double>(count - 1));
  const auto first = static_cast<std::size_t>(clamped);
  return {first, std::min(first + 1, count - 1), clamped - static_cast<double>(first)};
}

double variation(const PhaseCentre& centre, double angle, double azimuth) {
  if (centre.variations.empty() || centre.variations.front().empty()) return 0.0;
  const std::size_t rows = centre.variations.size();
  const Between row = between(rows > 1 ? azimuth / (2.0 * std::numbers::pi) * static_cast<double>(rows - 1) : 0.0, rows);
  const Between column = between((angle - centre.first) / centre.step, centre.variations.front().size());
  const auto at = [&](std::size_t r) {
    const std::vector<double>& values = centre.variations[r];
    return (1.0 - column.weight) * values[column.first] + column.weight * values[column.second];
  };
  return (1.0 - row.weight) * at(row.first) + row.weight * at(row.second);
}

}  // namespace

double phase_centre_correction(const record::AntennaCalibration& antenna, SatelliteSystem system, char band,
                               const Direction& direction) {
  const PhaseCentre* centre = centre_of(antenna, system, band);
  if (centre == nullptr) return 0.0;
  const double c = std::cos(direction.elevation);
  const Eigen::Vector3d way(c * std::cos(direction.azimuth), c * std::sin(direction.azimuth), std::sin(direction.elevation));
  return variation(*centre, 0.5 * std::numbers::pi - direction.elevation, direction.azimuth) - centre->offset.dot(way);
}

const record::AntennaCalibration* find_antenna(const record::AntennaTable& table, std::string_view name) {
  constexpr std::size_t kRadome = 16;
  std::string wanted(name.substr(0, kRadome + 4));
  wanted.resize(kRadome + 4, ' ');
  std::string bare = wanted.substr(0, kRadome) + "NONE";
  for (const std::string& type : {wanted, bare}) {
    const auto found = std::ranges::find_if(
        table.antennas, [&](const record::AntennaCalibration& a) { return !a.satellite && a.type == type; });
    if (found != table.antennas.end()) return &*found;
  }
  return nullptr;
}

}  // namespace coast::carrier
