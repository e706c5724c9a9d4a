// SBF, the binary format of Septentrio receivers: observations, ephemerides, positions, events and the receiver's IMU.

#include "../sbf/sbf_blocks.hpp"
#include "../sbf/sbf_readers.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool sniff_sbf(const FileHead& head) {
  // NMEA text or replies to commands may come first, for longer than the head.
  return begins_as_sbf(head.text) || head.path.ends_with(".sbf");
}

}  // namespace

Format sbf_format() {
  Format format{"sbf", "SBF of Septentrio receivers", sniff_sbf, read_sbf_imu, read_sbf_gnss, {}};
  format.read_observations = read_sbf_observations;
  format.read_navigation = read_sbf_navigation;
  format.read_time_marks = read_sbf_time_marks;
  format.count_messages = [](const std::filesystem::path& file) { return count_frames(file, kSbfLog); };
  return format;
}

}  // namespace coast::io
