#pragma once
// Records of stated size from a file, and what is wrong with them. Private to the room.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "coast/io/input.hpp"
#include "coast/record/event.hpp"

namespace coast::io {

/// Bytes one after another, of which one record at a time is in memory.
class BagSource {
 public:
  /// The largest chunk, packed or not, and the largest message outside of chunks. Recorders write chunks of 1 to 4 MiB.
  static constexpr std::uint64_t kMost = std::uint64_t{256} << 20;

  explicit BagSource(const std::filesystem::path& file) : source_(file) {}

  /// Exactly `size` bytes in place of what `to` has.  @return false: the file ends before; `to` has the rest
  /// @throws InputError  more than kMost, in a file of that length
  [[nodiscard]] bool read(std::string& to, std::uint64_t size);
  /// @return false: the file ends before
  [[nodiscard]] bool skip(std::uint64_t size);

  [[nodiscard]] std::uint64_t position() const { return position_; }
  [[nodiscard]] std::uint32_t crc() const { return crc_; }  ///< CRC-32 of all bytes so far
  [[nodiscard]] const std::string& name() const { return source_.name(); }

 private:
  [[nodiscard]] bool append(std::string& to, std::size_t size);
  ByteSource source_;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;
};

/// What was wrong with a bag, counted.
struct BagDamage {
  long chunks = 0;               ///< damaged ones, left out whole
  long undefined = 0;            ///< messages without a definition, and records inside chunks that are none
  long checksums = 0;            ///< of a whole file
  bool cut_off = false;          ///< the end of the file cuts a record off
  bool not_closed = false;       ///< the recorder did not end the file
  std::uint64_t stopped_at = 0;  ///< 0, or where what is no record begins

  [[nodiscard]] record::Events events(const std::string& file) const;
};

}  // namespace coast::io
