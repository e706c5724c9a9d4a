#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"

namespace coast::record {

/// Position, velocity and attitude of the body (IMU point) against the Earth, resolved in e.
struct NavState {
  geo::GpsTime t;
  Eigen::Vector3d r_eb_e = Eigen::Vector3d::Zero();           ///< m
  Eigen::Vector3d v_eb_e = Eigen::Vector3d::Zero();           ///< m/s
  Eigen::Quaterniond q_b_e = Eigen::Quaterniond::Identity();  ///< takes b to e
};

/// Covariances of the errors resolved in N, E, D at the point: position m^2, velocity (m/s)^2, attitude psi_n rad^2.
struct NavCovariance {
  Eigen::Matrix3d position = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d velocity = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Zero();
};

/// One epoch of a computed trajectory. Trajectories at IMU rate are streamed, epoch by epoch, into sinks.
struct TrajectoryEpoch {
  NavState nav;
  NavCovariance cov;
};
using EpochSink = std::function<void(const TrajectoryEpoch&)>;

/// A trajectory read from a file (a reference, or one side of a comparison). What the file lacks is said by the flags.
struct Trajectory {
  std::string source;
  std::vector<NavState> states;  ///< strictly increasing in time
  bool has_velocity = true;
  bool has_attitude = true;
  Events events;
};

}  // namespace coast::record
