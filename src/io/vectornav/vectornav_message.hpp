#pragma once
// Binary output of VectorNav sensors: which fields a message has, and where. Private to the room.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace coast::io {

/// Groups by their bit in the byte that names them (VectorNav ICD for VN-310, "binary output message").
enum class VectorNavGroup : std::uint8_t { kCommon, kTime, kImu, kGnss1, kAttitude, kIns, kGnss2 };

/// The fields of one message.
class VectorNavMessage {
 public:
  /// What the bytes after the sync byte tell.
  enum class Head : std::uint8_t { kWhole, kMore, kUnknown };
  /// The sensor pads the heads of fields of varying length by a reserved byte, which records do not keep.
  enum class Form : std::uint8_t { kSent, kRecorded };

  /// Reads the groups, their fields, and as much of the fields as their sizes depend on.
  /// @param bytes  from the byte of the groups on
  /// @return kMore: more than `size()` bytes are needed; kUnknown: a group or field of unknown size
  [[nodiscard]] Head parse(std::string_view bytes, Form form = Form::kSent);

  /// Of groups, field masks and fields: without sync byte and CRC.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::uint8_t groups() const { return groups_; }
  /// A field from its first byte on; none if the message does not have it.
  [[nodiscard]] std::optional<std::string_view> field(VectorNavGroup group, int bit) const;
  [[nodiscard]] Form form() const { return form_; }

 private:
  [[nodiscard]] Head parse_masks(std::string_view bytes);
  [[nodiscard]] Head parse_group(std::string_view bytes, std::size_t group);

  static constexpr std::size_t kGroups = 7, kBits = 32;
  std::string_view bytes_;
  Form form_ = Form::kSent;
  std::uint8_t groups_ = 0;
  std::size_t size_ = 0;
  std::array<std::uint32_t, kGroups> masks_{};
  std::array<std::array<std::uint16_t, kBits>, kGroups> offsets_{};
};

}  // namespace coast::io
