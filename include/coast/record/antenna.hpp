#pragma once
// Phase centres of antennas, as tabulated by calibrations.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"
#include "coast/record/satellite.hpp"

namespace coast::record {

/// Mean phase centre offset and phase centre variations of one band.
struct PhaseCentre {
  /// m. Receiver antenna: north, east, up from the antenna reference point. Satellite antenna: x, y, z of the satellite's body
  /// from the centre of mass; z points to the Earth, y is along the solar panels.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  double first = 0.0;  ///< rad: zenith distance (receiver) or nadir angle (satellite) of the first column
  double step = 0.0;   ///< rad, from column to column
  /// Rows by azimuth from 0 in equal steps up to 2 pi, or one row for all azimuths; m.
  std::vector<std::vector<double>> variations;
};

struct AntennaCalibration {
  std::string type;                    ///< IGS name and radome, twenty columns; for a satellite its block type
  std::optional<Satellite> satellite;  ///< set for a satellite's antenna
  std::optional<geo::GpsTime> from, until;
  std::map<std::pair<SatelliteSystem, char>, PhaseCentre> bands;
};

struct AntennaTable {
  std::string source;
  std::vector<AntennaCalibration> antennas;
  Events events;
};

}  // namespace coast::record
