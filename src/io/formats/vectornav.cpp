// Binary output of VectorNav sensors, as recorded from their serial port: IMU and positions of GNSS.

#include "../vectornav/vectornav_readers.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool sniff_vectornav(const FileHead& head) {
  return begins_as_vectornav(head.text);
}

}  // namespace

Format vectornav_format() {
  return {"vectornav", "binary output of VectorNav sensors", sniff_vectornav, read_vectornav_imu, read_vectornav_gnss, {}};
}

}  // namespace coast::io
