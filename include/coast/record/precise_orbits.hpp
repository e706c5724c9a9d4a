#pragma once
// Satellite orbits and clocks as tabulated by analysis centres.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"
#include "coast/record/satellite.hpp"

namespace coast::record {

/// One line of the table.
struct OrbitPoint {
  geo::GpsTime t;
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();  ///< centre of mass, ECEF, m
  std::optional<double> clock_s;                  ///< without the periodic relativistic effect
};

/// A satellite's clock at one instant.
struct ClockPoint {
  geo::GpsTime t;
  double clock_s = 0.0;  ///< without the periodic relativistic effect
};

struct PreciseClocks {
  std::string source;
  std::map<Satellite, std::vector<ClockPoint>> points;  ///< strictly increasing in time
  Events events;
};

struct PreciseOrbits {
  std::string source;
  std::map<Satellite, std::vector<OrbitPoint>> points;  ///< strictly increasing in time
  Events events;
};

}  // namespace coast::record
