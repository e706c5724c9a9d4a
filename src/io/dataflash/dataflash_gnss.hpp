#pragma once
// Positions in a DataFlash log, with the autopilot's clock. Private to the room.

#include <Eigen/Core>
#include <map>
#include <span>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/geo/time.hpp"
#include "dataflash_stream.hpp"

namespace coast::io {

/// One message GPS, with GPA of the same instant if there is one.
struct DataflashPosition {
  std::int64_t boot_us = 0;       ///< when the message arrived, by the autopilot's clock
  std::optional<geo::GpsTime> t;  ///< none while the receiver does not know it
  int status = 0;
  geo::Geodetic place;                            ///< with the height above mean sea level
  std::optional<double> geoid;                    ///< m above the ellipsoid, if the receiver says it
  double horizontal_sd = 0.0, vertical_sd = 0.0;  ///< m, of both horizontal components together; 0: not stated
  Eigen::Vector3d velocity_n = Eigen::Vector3d::Zero();
  double speed_sd = 0.0;  ///< m/s, three-dimensional; 0: not stated
  bool vertical_speed = true;
  int satellites = 0;
};

/// Positions of all receivers of a log.
class DataflashPositions {
 public:
  /// Takes messages GPS, GPS2, .. and GPA, GPA2, ..; others are no matter.
  void take(const DataflashMessage& message);
  /// Of the first receiver.
  [[nodiscard]] std::span<const DataflashPosition> first() const;

 private:
  std::map<int, std::vector<DataflashPosition>> receivers_;
};

}  // namespace coast::io
