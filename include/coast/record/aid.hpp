#pragma once
// Samples of an aiding sensor: odometer, second antenna, barometer, surveyed points. Plain data.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"

namespace coast::record {

/// One sample. How many components it has, and their units, depend on the kind of aid; the others are zero.
struct AidSample {
  geo::GpsTime t;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();  ///< zero: not in the file
};

struct AidRecording {
  std::string source;              ///< file it was read from
  std::vector<AidSample> samples;  ///< strictly increasing in time
  Events events;
};

}  // namespace coast::record
