#pragma once
// Single-point positioning: position of one receiver to some metres from its codes, velocity from Doppler.

#include <Eigen/Core>
#include <map>
#include <vector>

#include "coast/carrier/ranges.hpp"
#include "coast/record/observation.hpp"

namespace coast::carrier {

/// Measurements of one satellite for a single-point solution.
struct CodeMeasurement {
  record::Satellite satellite;
  SatelliteState state;              ///< at transmission
  double code = 0.0;                 ///< m
  double iono_factor = 1.0;          ///< (f1/f)^2; 0 for the ionosphere-free combination
  std::optional<double> range_rate;  ///< m/s, from Doppler: positive for increasing range
  double noise = 1.0;                ///< sd relative to that of a single code
};

struct SinglePoint {
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_e = Eigen::Matrix3d::Zero();  ///< m^2
  double clock_s = 0.0;                                    ///< receiver clock error, positive ahead of GPS time
  int satellites = 0;                                      ///< used
  std::vector<record::Satellite> left_out;                 ///< their codes do not agree with the others
  struct Velocity {
    Eigen::Vector3d v_e = Eigen::Vector3d::Zero();           ///< m/s
    Eigen::Matrix3d covariance_e = Eigen::Matrix3d::Zero();  ///< (m/s)^2
  };
  std::optional<Velocity> velocity;  ///< if there are four Dopplers
};

/// Least squares with one clock per system, satellites weighted by elevation; while the residuals exceed the code noise, the
/// satellite with the largest test statistic is left out (Teunissen 2000: w-test).
/// @param t  as the receiver's clock showed it  @param start_e  start value, ECEF, m; zero is good enough
/// @param elevation_mask  rad
/// @return none with fewer satellites than unknowns, weak geometry, or codes that contradict each other
[[nodiscard]] std::optional<SinglePoint> single_point(const std::vector<CodeMeasurement>& measurements, geo::GpsTime t,
                                                      const Eigen::Vector3d& start_e, const AirModel& air,
                                                      double elevation_mask);

}  // namespace coast::carrier
