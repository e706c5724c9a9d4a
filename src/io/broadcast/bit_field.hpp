#pragma once
// Numbers in navigation messages: fields of bits, the first bit the highest. Private to the room.

#include <cstddef>
#include <cstdint>
#include <span>

namespace coast::io {

/// Bits of a message in bytes, numbered from 0.
class BitField {
 public:
  explicit BitField(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// Up to 32 bits. Bits beyond the end are zero.
  [[nodiscard]] std::uint32_t bits(std::size_t at, std::size_t count) const {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + count; ++i) value = value << 1 | bit(i);
    return value;
  }
  /// Two's complement.
  [[nodiscard]] std::int32_t signed_bits(std::size_t at, std::size_t count) const {
    const std::uint32_t value = bits(at, count);
    const std::uint32_t sign = 1U << (count - 1);
    return static_cast<std::int32_t>((value ^ sign) - sign);
  }
  /// The first bit is the sign (GLONASS).
  [[nodiscard]] std::int32_t magnitude_bits(std::size_t at, std::size_t count) const {
    const auto magnitude = static_cast<std::int32_t>(bits(at + 1, count - 1));
    return bit(at) != 0 ? -magnitude : magnitude;
  }

 private:
  [[nodiscard]] std::uint32_t bit(std::size_t at) const {
    return at / 8 < bytes_.size() ? bytes_[at / 8] >> (7 - at % 8) & 1U : 0U;
  }
  std::span<const std::uint8_t> bytes_;
};

/// Fields one after another.
class BitCursor {
 public:
  BitCursor(const BitField& field, std::size_t at) : field_(field), at_(at) {}
  /// The next bits, scaled by 2^exponent.
  [[nodiscard]] double number(std::size_t count, int exponent);
  [[nodiscard]] double signed_number(std::size_t count, int exponent);
  [[nodiscard]] int integer(std::size_t count) { return static_cast<int>(field_.bits(advance(count), count)); }
  void skip(std::size_t count) { at_ += count; }

 private:
  std::size_t advance(std::size_t count) {
    const std::size_t at = at_;
    at_ += count;
    return at;
  }
  const BitField& field_;
  std::size_t at_;
};

}  // namespace coast::io
