#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"
#include "coast/record/gnss.hpp"

namespace coast::record {

/// Position, velocity and attitude of the body (IMU reference point) with respect to the Earth, resolved in e.
struct NavState {
  geo::GpsTime t;
  Eigen::Vector3d r_eb_e = Eigen::Vector3d::Zero();           ///< m
  Eigen::Vector3d v_eb_e = Eigen::Vector3d::Zero();           ///< m/s
  Eigen::Quaterniond q_b_e = Eigen::Quaterniond::Identity();  ///< takes b to e
};

/// Covariances of the errors resolved in N, E, D at the position: position m^2, velocity (m/s)^2, attitude psi_n rad^2.
struct NavCovariance {
  Eigen::Matrix3d position = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d velocity = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Zero();
};

/// Motion of the body with respect to the Earth, in body axes: means over the interval that ends at the epoch.
struct BodyMotion {
  Eigen::Vector3d omega_eb_b = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d a_eb_b = Eigen::Vector3d::Zero();      ///< acceleration, without gravity, m/s^2
};

/// Quality data of the GNSS fix on which a position is based.
struct GnssSupport {
  FixQuality quality = FixQuality::kUnknown;
  std::optional<int> satellites;
  std::optional<double> age_s;
  std::optional<double> ratio;
};

/// One epoch of a computed trajectory. Trajectories at IMU rate are streamed, epoch by epoch, into sinks.
struct TrajectoryEpoch {
  NavState nav;
  NavCovariance cov;
  BodyMotion motion = {};                ///< filled in for writers
  std::optional<GnssSupport> gnss = {};  ///< filled in for writers; absent: no GNSS
};
using EpochSink = std::function<void(const TrajectoryEpoch&)>;

/// A trajectory read from a file (a reference, or one side of a comparison). The flags show what the file does not contain.
struct Trajectory {
  std::string source;
  std::vector<NavState> states;  ///< strictly increasing in time
  bool has_velocity = true;
  bool has_attitude = true;
  Events events;
};

}  // namespace coast::record
