#pragma once
// Numbers in navigation messages: fields of bits, the first bit the highest. Private to the room.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

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

/// Of the bytes of a message in a file.
[[nodiscard]] inline BitField bits_of(std::string_view bytes) {
  return BitField({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

/// Fields one after another.
class BitCursor {
 public:
  BitCursor(const BitField& field, std::size_t at) : field_(field), at_(at) {}
  /// The next bits, scaled by 2^exponent.
  [[nodiscard]] double number(std::size_t count, int exponent);
  [[nodiscard]] double signed_number(std::size_t count, int exponent);
  /// The first bit is the sign (GLONASS).
  [[nodiscard]] double magnitude_number(std::size_t count, int exponent);
  [[nodiscard]] int signed_integer(std::size_t count) { return field_.signed_bits(advance(count), count); }
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

/// Copies bits to the end of a string of bits, which begins at bit `at`.
template <std::size_t Bytes>
class BitWriter {
 public:
  explicit BitWriter(std::size_t at = 0) : at_(at) {}
  void append(const BitField& from, std::size_t at, std::size_t count) {
    for (std::size_t i = at; i < at + count; ++i, ++at_)
      bytes_.at(at_ / 8) = static_cast<std::uint8_t>(bytes_.at(at_ / 8) | from.bits(i, 1) << (7 - at_ % 8));
  }
  [[nodiscard]] const std::array<std::uint8_t, Bytes>& bytes() const { return bytes_; }

 private:
  std::array<std::uint8_t, Bytes> bytes_{};
  std::size_t at_;
};

}  // namespace coast::io
