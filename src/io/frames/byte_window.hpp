#pragma once
// The bytes of a file in a moving window. Private to the room.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "coast/io/input.hpp"

namespace coast::io {

/// Bytes ahead of a position in a file, of which never more than the window is in memory.
class ByteWindow {
 public:
  /// The most that `ahead` can be asked for: half a block of files that do not fit into one.
  static constexpr std::size_t kMost = std::size_t{1} << 17;

  explicit ByteWindow(const std::filesystem::path& file) : source_(file), buffer_(source_.block()) {}

  /// All bytes in memory from the position on, at least `least` (at most kMost); fewer only at the end of the file. The view is
  /// valid until the next call.
  [[nodiscard]] std::string_view ahead(std::size_t least);
  /// Moves on by bytes that `ahead` has shown.
  void advance(std::size_t bytes) { begin_ += bytes; }

  /// Of the next byte, in the decompressed file.
  [[nodiscard]] std::uint64_t position() const { return before_ + begin_; }
  [[nodiscard]] const std::string& name() const { return source_.name(); }
  [[nodiscard]] std::uint64_t expected_size() const { return source_.expected_size(); }

 private:
  ByteSource source_;
  std::vector<char> buffer_;
  std::uint64_t before_ = 0;  ///< position of the first byte of the buffer
  std::size_t begin_ = 0;     ///< first byte ahead
  std::size_t end_ = 0;       ///< end of the valid bytes
  bool exhausted_ = false;
};

}  // namespace coast::io
