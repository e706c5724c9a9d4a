#pragma once
// IMU samples of an autopilot, which have its own time since it was started. Private to the room.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "clock_tie.hpp"
#include "coast/io/imu.hpp"

namespace coast::io {

/// us; a hundred years. Damaged times beyond must not overflow in sums.
inline constexpr std::int64_t kLongestUptime = std::int64_t{3'200'000'000} * 1'000'000;

/// A gyro or an accelerometer at the autopilot's time.
struct BootTriad {
  std::int64_t boot_us = 0;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

struct BootImuRow {
  std::int64_t boot_us = 0;
  Eigen::Vector3d gyro, accel;  ///< rad/s, m/s^2
};

/// Specific forces interpolated to the times of the gyro, whose samples are not taken at the same instants.
[[nodiscard]] std::vector<BootImuRow> paired_triads(std::span<const BootTriad> gyros, std::span<const BootTriad> accels);

/// The recording of samples in their order, in GPS time by a fitted tie to the times when positions arrived.
/// @param source  the file, for messages  @param damage  events of the file itself, which come first
[[nodiscard]] record::ImuRecording boot_clock_imu(std::span<const BootImuRow> rows, const ClockTie& tie,
                                                  const ImuFileOptions& options, const std::string& source,
                                                  record::Events damage);

}  // namespace coast::io
