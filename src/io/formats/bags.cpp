// Bags of ROS: three containers with the same messages.

#include "../bags/bag_readers.hpp"
#include "../bags/bag_topics.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

Format bag_format(std::string_view name, std::string_view description, bool (*begins)(std::string_view), OpenBag open) {
  Format format{
      name,
      description,
      [begins](const FileHead& head) { return begins(head.text); },
      [open](const ImuFileOptions& options, Format::Near near) { return read_bag_imu(open, options, near); },
      [open](const GnssFileOptions& options, Format::Near near) { return read_bag_gnss(open, options, near); },
      [open](const ReferenceFileOptions& options, Format::Near near) { return read_bag_reference(open, options, near); }};
  format.count_messages = [open](const std::filesystem::path& file) { return count_bag_messages(*open(file)); };
  return format;
}

}  // namespace

Format rosbag_format() {
  return bag_format("rosbag", "bag of ROS 1", begins_as_rosbag1, open_rosbag1);
}

Format mcap_format() {
  return bag_format("mcap", "MCAP, bag of ROS 2", begins_as_mcap, open_mcap);
}

Format rosbag2_format() {
  return bag_format("rosbag2", "bag of ROS 2 in SQLite", begins_as_sqlite, open_rosbag2);
}

}  // namespace coast::io
