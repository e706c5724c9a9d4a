#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"

namespace coast::record {

/// Increments over (t - dt, t].
struct ImuSample {
  geo::GpsTime t;          ///< end of the interval
  double dt = 0.0;         ///< s, > 0
  Eigen::Vector3d dtheta;  ///< integral of omega_ib, rad
  Eigen::Vector3d dv;      ///< integral of f_ib, m/s
};

/// One IMU as recorded, in the sensor's own axes unless a function says otherwise. Strictly increasing in time.
struct ImuRecording {
  std::string source;  ///< file, for messages
  std::vector<ImuSample> samples;
  std::vector<float> temperature;  ///< degC, one per sample, or empty
  double rate_hz = 0.0;            ///< 1 / median interval
  Events events;                   ///< repairs and gaps found on reading
};

}  // namespace coast::record
