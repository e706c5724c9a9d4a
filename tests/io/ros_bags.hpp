#pragma once
// Messages of ROS and the containers that carry them, as recorders write them. Shares no code with the readers.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/receiver_messages.hpp"

namespace coast::test {

/// Fields of a message in one of the serialisations.
class RosBytes {
 public:
  enum class As { kRos1, kCdrLittle, kCdrBig };
  explicit RosBytes(As as) : as_(as) {
    if (as == As::kCdrLittle) bytes_ = std::string("\0\1\0\0", 4);
    if (as == As::kCdrBig) bytes_ = std::string("\0\0\0\0", 4);
    start_ = bytes_.size();
  }
  template <class T>
  RosBytes& put(std::type_identity_t<T> value) {
    while (as_ != As::kRos1 && (bytes_.size() - start_) % sizeof(T) != 0) bytes_ += '\x55';  // padding may be anything
    std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
    if (as_ == As::kCdrBig) raw = std::string(raw.rbegin(), raw.rend());
    bytes_ += raw;
    return *this;
  }
  RosBytes& text(const std::string& value) {
    put<std::uint32_t>(static_cast<std::uint32_t>(value.size() + (as_ == As::kRos1 ? 0 : 1)));
    bytes_ += value;
    if (as_ != As::kRos1) bytes_ += '\0';
    return *this;
  }
  RosBytes& numbers(const std::vector<double>& values) {
    for (const double value : values) put<double>(value);
    return *this;
  }
  RosBytes& header(std::int64_t ns, const std::string& frame = "imu_link") {
    if (as_ == As::kRos1) put<std::uint32_t>(77);
    put<std::uint32_t>(static_cast<std::uint32_t>(ns / 1'000'000'000));
    put<std::uint32_t>(static_cast<std::uint32_t>(ns % 1'000'000'000));
    return text(frame);
  }
  [[nodiscard]] const std::string& str() const { return bytes_; }

 private:
  As as_;
  std::string bytes_;
  std::size_t start_ = 0;
};

inline std::string ros_imu(RosBytes::As as, std::int64_t ns, double gyro_x, double covariance = 0.0) {
  RosBytes b(as);
  b.header(ns).numbers({0, 0, 0, 1}).numbers({-1, 0, 0, 0, 0, 0, 0, 0, 0});
  b.numbers({gyro_x, 0.5, -0.25}).numbers({covariance, 0, 0, 0, 0, 0, 0, 0, 0});
  return b.numbers({0.125, -0.5, 9.75}).numbers({0, 0, 0, 0, 0, 0, 0, 0, 0}).str();
}

struct RosFixValues {
  int status = 0;
  double latitude = 47.5, longitude = 8.25, height = 512.5;
  std::vector<double> covariance = {4.0, 0.5, 0.25, 0.5, 1.0, -0.125, 0.25, -0.125, 9.0};  // east, north, up
  unsigned kind = 3;
};

inline std::string ros_fix(RosBytes::As as, std::int64_t ns, const RosFixValues& v = {}) {
  RosBytes b(as);
  b.header(ns, "gps").put<std::int8_t>(static_cast<std::int8_t>(v.status)).put<std::uint16_t>(1);
  b.numbers({v.latitude, v.longitude, v.height}).numbers(v.covariance);
  return b.put<std::uint8_t>(static_cast<std::uint8_t>(v.kind)).str();
}

/// A message of a bag, in whatever container.
struct BagEntry {
  int topic = 0;
  std::int64_t log_ns = 0;
  std::string bytes;
};
struct BagTopicName {
  std::string name, type;
};

// --- ROS 1

inline std::string with_length(const std::string& text) {
  return Bytes().u4(static_cast<std::uint32_t>(text.size())).text(text).str();
}
inline std::string rosbag_record(const std::vector<std::string>& fields, const std::string& data) {
  std::string header;
  for (const std::string& field : fields) header += with_length(field);
  return with_length(header) + with_length(data);
}
inline std::string rosbag_op(unsigned op) {
  return "op=" + std::string(1, static_cast<char>(op));
}
inline std::string rosbag_connection(int id, const BagTopicName& topic) {
  return rosbag_record({rosbag_op(7), "conn=" + Bytes().u4(static_cast<std::uint32_t>(id)).str(), "topic=" + topic.name},
                       with_length("topic=" + topic.name) + with_length("type=" + topic.type) + with_length("md5sum=*"));
}
inline std::string rosbag_message(const BagEntry& entry) {
  const std::string time = Bytes()
                               .u4(static_cast<std::uint32_t>(entry.log_ns / 1'000'000'000))
                               .u4(static_cast<std::uint32_t>(entry.log_ns % 1'000'000'000))
                               .str();
  return rosbag_record({"conn=" + Bytes().u4(static_cast<std::uint32_t>(entry.topic)).str(), rosbag_op(2), "time=" + time},
                       entry.bytes);
}
inline std::string rosbag_head(std::uint64_t index_at) {
  return "#ROSBAG V2.0\n" +
         rosbag_record({rosbag_op(3), "index_pos=" + Bytes().put<std::uint64_t>(index_at).str()}, std::string(64, ' '));
}
/// @param packed  the content, compressed by the stated program
inline std::string rosbag_chunk(const std::string& compression, const std::string& packed, std::size_t size) {
  return rosbag_record(
      {"compression=" + compression, rosbag_op(5), "size=" + Bytes().u4(static_cast<std::uint32_t>(size)).str()}, packed);
}

// --- MCAP

inline std::string mcap_text(const std::string& text) {
  return with_length(text);
}
inline std::string mcap_record(unsigned op, const std::string& content) {
  return Bytes().u1(op).put<std::uint64_t>(content.size()).text(content).str();
}
inline const std::string kMcapMagicBytes = "\x89MCAP0\r\n";
inline std::string mcap_head() {
  return kMcapMagicBytes + mcap_record(1, mcap_text("ros2") + mcap_text("test"));
}
inline std::string mcap_schema(unsigned id, const std::string& type) {
  return mcap_record(3, Bytes().u2(id).text(mcap_text(type) + mcap_text("ros2msg") + mcap_text("any")).str());
}
inline std::string mcap_channel(unsigned id, unsigned schema, const std::string& topic, const std::string& encoding = "cdr") {
  return mcap_record(4, Bytes().u2(id).u2(schema).text(mcap_text(topic) + mcap_text(encoding)).u4(0).str());
}
inline std::string mcap_message(const BagEntry& entry) {
  Bytes b;
  b.u2(static_cast<unsigned>(entry.topic)).u4(1).put<std::uint64_t>(static_cast<std::uint64_t>(entry.log_ns));
  return mcap_record(5, b.put<std::uint64_t>(0).text(entry.bytes).str());
}
/// CRC-32 as Ethernet has it, bit by bit.
inline std::uint32_t crc32_bit_by_bit(const std::string& bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1 ^ 0xEDB88320U : crc >> 1;
  }
  return ~crc;
}
inline std::string mcap_chunk(const std::string& content, const std::string& compression, const std::string& packed,
                              bool with_crc = true) {
  Bytes b;
  b.put<std::uint64_t>(0).put<std::uint64_t>(0).put<std::uint64_t>(content.size());
  b.u4(with_crc ? crc32_bit_by_bit(content) : 0).text(mcap_text(compression)).put<std::uint64_t>(packed.size()).text(packed);
  return mcap_record(6, b.str());
}
/// The end of the data with their checksum, a footer without a summary.
inline std::string mcap_end(const std::string& before) {
  return mcap_record(15, Bytes().u4(crc32_bit_by_bit(before)).str()) + mcap_record(2, Bytes().zeros(20).str()) +
         kMcapMagicBytes;
}

}  // namespace coast::test
