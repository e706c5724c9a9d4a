#pragma once
// IMUs whose samples have no time tag, only a counter and the time at which a computer received them.

#include <filesystem>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/io/table.hpp"
#include "coast/record/packet.hpp"

namespace coast::io {

/// The keys of an IMU that is logged packet by packet.
///
///     file: imu1.csv
///     columns: {counter: counter, arrival: arrival_s, gyro: [gx, gy, gz], accel: [ax, ay, az], gps: gps_s, pulse: pulse}
///     units: {gyro: deg/s, accel: m/s^2}
///
/// `gps` (seconds of week, of the device that has them) and `pulse` (number of the sync pulse) are optional, and may be empty
/// or nan in a row.
struct PacketFileOptions {
  std::filesystem::path file;
  Column counter, arrival;
  Column gps, pulse;  ///< empty: none
  std::vector<Column> gyro, accel;
  double gyro_to_si = 1.0;
  double accel_to_si = 1.0;

  [[nodiscard]] static PacketFileOptions from(const config::Node& imu);
};

/// Reads packets in the order of the file. Rows whose rates or specific forces are not finite are left out with an event.
/// @throws InputError  anything that cannot be read as stated, counters that are not whole numbers, fewer than two rows
[[nodiscard]] record::PacketRecording read_packets(const PacketFileOptions& options);

}  // namespace coast::io
