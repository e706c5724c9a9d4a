#pragma once
// Messages of bags, whatever the container. Private to the room.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "coast/record/event.hpp"

namespace coast::io {

/// How the bytes of a message are to be read.
enum class BagEncoding : std::uint8_t { kRos1, kCdr, kOther };

struct BagTopic {
  std::string name;
  std::string type;  ///< as ROS 1 has it: "sensor_msgs/Imu"
  BagEncoding encoding = BagEncoding::kOther;
};

struct BagMessage {
  const BagTopic* topic = nullptr;
  std::int64_t log_ns = 0;  ///< when it was recorded, since 1970
  std::string_view bytes;   ///< valid until the next call; empty for types that are not decoded if they need not be read
};

/// A container's messages in the order of the file.
class BagStream {
 public:
  BagStream() = default;
  BagStream(const BagStream&) = delete;
  BagStream& operator=(const BagStream&) = delete;
  virtual ~BagStream() = default;
  /// @throws InputError  what cannot be read at all
  [[nodiscard]] virtual bool next(BagMessage& message) = 0;
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// Damage.
  [[nodiscard]] virtual record::Events events() const = 0;
};

using OpenBag = std::unique_ptr<BagStream> (*)(const std::filesystem::path&);
/// @throws InputError  not such a file
[[nodiscard]] std::unique_ptr<BagStream> open_rosbag1(const std::filesystem::path& file);
[[nodiscard]] std::unique_ptr<BagStream> open_mcap(const std::filesystem::path& file);
[[nodiscard]] std::unique_ptr<BagStream> open_rosbag2(const std::filesystem::path& file);

/// The first bytes of a file are those of such a container.
[[nodiscard]] bool begins_as_rosbag1(std::string_view head);
[[nodiscard]] bool begins_as_mcap(std::string_view head);
[[nodiscard]] bool begins_as_sqlite(std::string_view head);

/// "sensor_msgs/msg/Imu" of ROS 2 as "sensor_msgs/Imu".
[[nodiscard]] std::string ros1_type(std::string_view type);

}  // namespace coast::io
