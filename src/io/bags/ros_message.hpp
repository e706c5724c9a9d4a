#pragma once
// Messages of ROS as they are serialised by ROS 1, or by ROS 2 as CDR. Private to the room.

#include <Eigen/Geometry>
#include <optional>

#include "bag_stream.hpp"

namespace coast::io {

/// sensor_msgs/Imu, as it stands there: rad/s, m/s^2.
struct RosImu {
  std::int64_t stamp_ns = 0;  ///< of the header; 0: not set
  Eigen::Vector3d gyro, accel;
  bool measured = true;  ///< false: a covariance of -1 says that a sensor is not there
};

/// sensor_msgs/NavSatFix.
struct RosFix {
  enum class Covariance : std::uint8_t { kUnknown = 0, kApproximated = 1, kDiagonal = 2, kKnown = 3 };
  std::int64_t stamp_ns = 0;
  std::int8_t status = 0;  ///< -2 unknown, -1 no fix, 0 fix, 1 SBAS, 2 ground-based augmentation
  double latitude_deg = 0, longitude_deg = 0, height = 0;  ///< above the ellipsoid
  Eigen::Matrix3d covariance_enu;                          ///< m^2
  Covariance covariance = Covariance::kUnknown;
};

/// The pose of geometry_msgs/PoseStamped, PoseWithCovarianceStamped, TransformStamped, and nav_msgs/Odometry.
struct RosPose {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position;
  Eigen::Quaterniond attitude;  ///< body to the frame of the position; as it stands there
};

inline constexpr std::string_view kRosImuType = "sensor_msgs/Imu";
inline constexpr std::string_view kRosFixType = "sensor_msgs/NavSatFix";
[[nodiscard]] bool is_ros_pose(std::string_view type);
/// One of these, in an encoding that is known.
[[nodiscard]] bool is_decoded(const BagTopic& topic);

/// None: the bytes are not such a message.
[[nodiscard]] std::optional<RosImu> ros_imu(const BagMessage& message);
[[nodiscard]] std::optional<RosFix> ros_fix(const BagMessage& message);
[[nodiscard]] std::optional<RosPose> ros_pose(const BagMessage& message);

}  // namespace coast::io
