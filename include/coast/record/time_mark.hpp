#pragma once
// Instants of outside events, such as a camera's shutter, as a receiver or a table has timed them.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::record {

enum class Edge { kNotStated, kRising, kFalling };

/// One edge at an input of the receiver, or one row of a table.
struct TimeMark {
  geo::GpsTime t;
  double sd_s = 0.0;  ///< as stated; 0: not stated
  int channel = 0;    ///< input
  Edge edge = Edge::kNotStated;
  int count = 0;                            ///< rising edges at this input so far, modulo 2^16
  std::string id = {};                      ///< name of the image, if stated
  std::optional<Eigen::Vector3d> r_e = {};  ///< position stated beside the time, ECEF, m
};

struct TimeMarkRecording {
  std::string source;
  std::vector<TimeMark> marks;  ///< in the order of time
  Events events;
};

/// The state of a device on the body at a mark.
struct MarkedState {
  TimeMark mark;      ///< as read
  NavState nav;       ///< of the device, at the mark plus its delay; q_b_e takes the device's axes to e
  NavCovariance cov;  ///< of the device
};

}  // namespace coast::record
