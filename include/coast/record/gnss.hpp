#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"

namespace coast::record {

/// RTKLIB's numbering, so that files and figures agree. kUnknown: not given in the file.
enum class FixQuality { kUnknown = 0, kFixed = 1, kFloat = 2, kSbas = 3, kDgps = 4, kSingle = 5, kPpp = 6 };

/// One GNSS position (and velocity) of the antenna.
struct GnssFix {
  geo::GpsTime t;
  Eigen::Vector3d r_ea_e;          ///< antenna, ECEF, m
  Eigen::Matrix3d position_cov_n;  ///< N, E, D, m^2, positive definite
  struct Velocity {
    Eigen::Vector3d v_ea_n;  ///< N, E, D, m/s
    Eigen::Matrix3d cov_n;   ///< (m/s)^2, positive definite
  };
  std::optional<Velocity> velocity;
  FixQuality quality = FixQuality::kUnknown;
  std::optional<int> satellites;
  std::optional<double> age_s;
  std::optional<double> ratio;
};

struct GnssRecording {
  std::string source;
  std::vector<GnssFix> fixes;  ///< strictly increasing in time
  Events events;
};

}  // namespace coast::record
