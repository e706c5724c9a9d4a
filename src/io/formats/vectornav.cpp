// Binary output of VectorNav sensors, as recorded from their serial port: IMU and positions of GNSS.

#include "../frames/frame_stream.hpp"
#include "../vectornav/vectornav_readers.hpp"
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
  format.count_messages = [](const std::filesystem::path& file) { return count_frames(file, kVectorNavLog); };
  return format;
}

}  // namespace coast::io
