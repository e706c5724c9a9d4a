#pragma once
// Mounting of the IMU in the body: which sensor axis points forward, right and down, and the remaining small rotation.

#include <Eigen/Core>

#include "coast/config/node.hpp"
#include "coast/record/imu.hpp"

namespace coast::ins {

/// Keys `axes` and `mounting_deg` of a run's `imu:` map.
struct MountingOptions {
  /// Rows: body forward, right, down in sensor axes; `axes: [-x, y, -z]` is diag(-1, 1, -1). A proper rotation.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// roll, pitch, yaw [rad] of the rotation that takes body to sensor once `axes` is applied.
  Eigen::Vector3d mounting = Eigen::Vector3d::Zero();

  /// @param imu  the `imu:` map; both keys may be missing
  /// @throws InputError  not three axes, an unknown axis, one used twice, a left-handed set; angles outside [-180, 180] (pitch
  /// 90) deg
  [[nodiscard]] static MountingOptions from(const config::Node& imu);
};

/// Sensor to body: v_b = C_s_b v_s.
///
///     C_s_b = (Rz(yaw) Ry(pitch) Rx(roll))^T axes
[[nodiscard]] Eigen::Matrix3d C_s_b(const MountingOptions& options);

/// Rotates every increment in place: sensor axes to body axes. The rotation commutes with compensation (phi and u rotate in the
/// same way).
void to_body(record::ImuRecording& recording, const Eigen::Matrix3d& C_s_b);

}  // namespace coast::ins
