#pragma once
// Where antennas' phase centres are, as calibrations tabulate them.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"
#include "coast/record/satellite.hpp"

namespace coast::record {

/// Of one band: the mean phase centre, and by how much phases are longer than from there.
struct PhaseCentre {
  /// From the antenna reference point, m: north, east, up of a receiver's antenna; x, y, z of a satellite's body, whose z
  /// points to the Earth and whose y is along its panels, from the centre of mass.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  double first = 0.0;  ///< rad: zenith distance (receiver) or nadir angle (satellite) of the first column
  double step = 0.0;   ///< rad, from column to column
  /// Rows by azimuth from 0 in equal steps up to 2 pi, or one row for all azimuths; m.
  std::vector<std::vector<double>> variations;
};

struct AntennaCalibration {
  std::string type;                    ///< IGS name and radome, twenty columns; of a satellite its block
  std::optional<Satellite> satellite;  ///< of a satellite's antenna
  std::optional<geo::GpsTime> from, until;
  std::map<std::pair<SatelliteSystem, char>, PhaseCentre> bands;
};

struct AntennaTable {
  std::string source;
  std::vector<AntennaCalibration> antennas;
  Events events;
};

}  // namespace coast::record
