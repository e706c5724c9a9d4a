#pragma once
// Positions in a flight log, with the autopilot's clock. Private to the room.

#include <Eigen/Core>
#include <span>

#include "coast/geo/earth.hpp"
#include "coast/geo/time.hpp"
#include "ulog_stream.hpp"

namespace coast::io {

/// One message of vehicle_gps_position or sensor_gps.
struct UlogPosition {
  std::int64_t boot_us = 0;       ///< the autopilot's clock at which UTC was read
  std::optional<geo::GpsTime> t;  ///< none while the receiver does not know UTC
  int fix_type = 0;
  geo::Geodetic place;
  double horizontal_sd = 0.0, vertical_sd = 0.0;  ///< m; horizontal: of both components together
  std::optional<Eigen::Vector3d> velocity_n;      ///< m/s
  double speed_sd = 0.0;                          ///< m/s, three-dimensional
  int satellites = 0;
};

/// Positions of all receivers of a log.
class UlogPositions {
 public:
  /// Takes messages of vehicle_gps_position and sensor_gps; others, and those without the fields, are no matter.
  void take(const UlogData& data);
  /// Of the receiver that the autopilot uses, vehicle_gps_position, or else of the first one, sensor_gps.
  [[nodiscard]] std::span<const UlogPosition> best() const;

 private:
  /// By topic: false for vehicle_gps_position, so that it comes first; then by instance.
  std::map<std::pair<bool, int>, std::vector<UlogPosition>> receivers_;
};

}  // namespace coast::io
