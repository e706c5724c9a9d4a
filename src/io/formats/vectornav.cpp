// Binary output of VectorNav sensors, as recorded from their serial port or as records: IMU, and
// positions and observations of GNSS.

#include "../vectornav/vectornav_readers.hpp"
#include "../vectornav/vectornav_stream.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool sniff_vectornav(const FileHead& head) {
  return begins_as_vectornav(head.text);
}

}  // namespace

Format vectornav_format() {
  Format format{"vectornav", "binary output of VectorNav sensors", sniff_vectornav, read_vectornav_imu, read_vectornav_gnss,
                {}};
  format.read_observations = read_vectornav_observations;
  format.count_messages = count_vectornav_messages;
  return format;
}

}  // namespace coast::io
