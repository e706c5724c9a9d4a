#pragma once
// Numbers in binary files with given byte order.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace coast::io {

/// The number at `offset` of `bytes`; the caller has checked that it is inside.
template <class T>
[[nodiscard]] T number_at(std::string_view bytes, std::size_t offset, bool big_endian = false) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes.data() + offset, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// Appends a number, little endian.
template <class T>
void append_number(std::string& bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace coast::io
