// DataFlash, the log of ArduPilot: the autopilot's IMU and the positions of its GNSS receiver.

#include "../dataflash/dataflash_readers.hpp"
#include "../dataflash/dataflash_stream.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool sniff_dataflash(const FileHead& head) {
  return begins_as_dataflash(head.text);
}

}  // namespace

Format dataflash_format() {
  Format format{"dataflash", "DataFlash, log of ArduPilot", sniff_dataflash, read_dataflash_imu, read_dataflash_gnss, {}};
  format.count_messages = count_dataflash_messages;
  return format;
}

}  // namespace coast::io
