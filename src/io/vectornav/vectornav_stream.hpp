#pragma once
// The messages of a VectorNav file, in either of the forms that it is recorded in. Private to the room.

#include <optional>
#include <string>

#include "../frames/frame_stream.hpp"
#include "vectornav_message.hpp"

namespace coast::io {

/// A log of fixed records: six field masks (u32: time, IMU, GNSS 1, attitude, INS, GNSS 2), then for each message the cycle and
/// week (u32) and seconds (f64) at which it was recorded, and its fields. It has neither sync bytes nor checksums: behind
/// damage that changes the length of a record nothing can be found again.
class VectorNavRecords {
 public:
  /// The file begins so, and its first message is whole and has a possible time.
  [[nodiscard]] static bool begins_in(std::string_view head);

  explicit VectorNavRecords(const std::filesystem::path& file);
  [[nodiscard]] bool next(VectorNavMessage& message);
  [[nodiscard]] const FrameCensus& census() const { return census_; }

 private:
  bool give_up(std::size_t bytes);

  ByteWindow window_;
  std::string message_;   ///< groups and masks as the sensor sends them, then the fields of this message
  std::size_t head_ = 0;  ///< bytes of groups and masks
  FrameCensus census_;
};

/// Messages as the sensor sends them on its serial port, or as records.
class VectorNavStream {
 public:
  explicit VectorNavStream(const std::filesystem::path& file);

  /// The next message; its fields are valid until the next call.
  [[nodiscard]] bool next(VectorNavMessage& message);
  [[nodiscard]] const FrameCensus& census() const { return records_ ? records_->census() : frames_.census(); }
  [[nodiscard]] const std::string& name() const { return frames_.name(); }

 private:
  FrameStream frames_;
  std::optional<VectorNavRecords> records_;
};

/// Number of messages by kind, the most frequent first.
[[nodiscard]] std::vector<MessageCount> count_vectornav_messages(const std::filesystem::path& file);

}  // namespace coast::io
