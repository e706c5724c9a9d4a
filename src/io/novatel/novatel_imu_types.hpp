#pragma once
// The IMUs that NovAtel's SPAN receivers know. Private to the room.

#include <cstdint>
#include <optional>
#include <string_view>

namespace coast::io {

/// One count of an increment.
struct NovAtelImuType {
  std::uint32_t number;   ///< of SETIMUTYPE, INSCONFIG and RAWIMUX
  std::string_view name;  ///< of SETIMUTYPE, without "IMU_"
  double gyro = 0.0;      ///< rad; 0: not known here
  double accel = 0.0;     ///< m/s
};

[[nodiscard]] std::optional<NovAtelImuType> novatel_imu_type(std::uint32_t number);
/// By the word of an ASCII log, with or without "IMU_".
[[nodiscard]] std::optional<NovAtelImuType> novatel_imu_type(std::string_view name);

}  // namespace coast::io
