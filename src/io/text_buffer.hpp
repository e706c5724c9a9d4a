#pragma once
// Numbers to text, fast: fixed decimals by integer arithmetic.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "coast/io/writers.hpp"

namespace coast::io {

/// A text that is written to a file in blocks.
class TextBuffer {
 public:
  explicit TextBuffer(AtomicFile& file) : file_(file) { text_.reserve(kBlock + 4096); }

  void put(char c) { text_.push_back(c); }
  void put(std::string_view s) { text_.append(s); }
  /// Fixed decimals, rounded to nearest (ties away from zero); at least `width` characters.
  /// @param value |value| 10^decimals below 9e18; others, and values that are not finite, are written as `nan`
  void put_fixed(double value, int decimals, int width = 0);
  void put_integer(std::int64_t value, int width = 0, char fill = ' ');
  void end_line() {
    text_.push_back('\n');
    if (text_.size() >= kBlock) flush();
  }
  void flush() {
    file_.write(text_);
    text_.clear();
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 16;
  AtomicFile& file_;
  std::string text_;
};

}  // namespace coast::io
