// UBX, the binary protocol of u-blox receivers: observations, navigation messages, positions and the receiver's IMU.

#include "../ubx/ubx_messages.hpp"
#include "../ubx/ubx_readers.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool sniff_ubx(const FileHead& head) {
  // NMEA text may come first, for longer than the head.
  return begins_as_ubx(head.text) || head.path.ends_with(".ubx");
}

}  // namespace

Format ubx_format() {
  Format format{"ubx", "UBX of u-blox receivers", sniff_ubx, read_ubx_imu, read_ubx_gnss, {}};
  format.read_observations = read_ubx_observations;
  format.read_navigation = read_ubx_navigation;
  format.read_time_marks = read_ubx_time_marks;
  format.count_messages = [](const std::filesystem::path& file) { return count_frames(file, kUbxLog); };
  return format;
}

}  // namespace coast::io
