// Logs of NovAtel receivers (OEM4 to OEM7, SPAN), binary and ASCII: observations, ephemerides, positions, IMU, trajectory and
// time marks.

#include "../novatel/novatel_log.hpp"
#include "../novatel/novatel_readers.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool sniff_novatel(const FileHead& head) {
  return begins_as_novatel(head.text);
}

}  // namespace

Format novatel_format() {
  Format format{"novatel",        "logs of NovAtel receivers", sniff_novatel,
                read_novatel_imu, read_novatel_gnss,           read_novatel_reference};
  format.read_observations = read_novatel_observations;
  format.read_navigation = read_novatel_navigation;
  format.read_time_marks = read_novatel_time_marks;
  format.count_messages = [](const std::filesystem::path& file) { return count_frames(file, kNovAtelLog); };
  return format;
}

}  // namespace coast::io
