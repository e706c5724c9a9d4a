// ULog, the flight log of PX4: the autopilot's IMU and the positions of its GNSS receiver.

#include "../ulog/ulog_readers.hpp"
#include "../ulog/ulog_stream.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool sniff_ulog(const FileHead& head) {
  return begins_as_ulog(head.text);
}

}  // namespace

Format ulog_format() {
  Format format{"ulog", "ULog, flight log of PX4", sniff_ulog, read_ulog_imu, read_ulog_gnss, {}};
  format.count_messages = count_ulog_topics;
  return format;
}

}  // namespace coast::io
