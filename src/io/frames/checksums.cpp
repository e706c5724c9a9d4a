#include "checksums.hpp"

#include <array>

namespace coast::io {

namespace {

/// Remainders of all bytes for a polynomial of `Bits` bits, whose highest term is left out.
template <int Bits>
constexpr std::array<std::uint32_t, 256> crc_table(std::uint32_t polynomial) {
  constexpr std::uint32_t kMask = (std::uint32_t{1} << Bits) - 1;
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
    std::uint32_t crc = byte << (Bits - 8);
    for (int bit = 0; bit < 8; ++bit) crc = ((crc << 1) ^ ((crc >> (Bits - 1) & 1U) != 0 ? polynomial : 0U)) & kMask;
    table[byte] = crc;
  }
  return table;
}

template <int Bits>
std::uint32_t crc_of(std::string_view bytes, const std::array<std::uint32_t, 256>& table) {
  constexpr std::uint32_t kMask = (std::uint32_t{1} << Bits) - 1;
  std::uint32_t crc = 0;
  for (const char c : bytes) crc = ((crc << 8) & kMask) ^ table[(crc >> (Bits - 8) ^ static_cast<unsigned char>(c)) & 0xffU];
  return crc;
}

}  // namespace

std::uint16_t fletcher8(std::string_view bytes) {
  // Sums of 32 bits do not overflow in what an unsigned sum keeps of them: only their low bytes count.
  std::uint32_t a = 0, b = 0;
  for (const char c : bytes) {
    a += static_cast<unsigned char>(c);
    b += a;
  }
  return static_cast<std::uint16_t>((a & 0xffU) | (b & 0xffU) << 8);
}

std::uint32_t crc24q(std::string_view bytes) {
  static constexpr auto table = crc_table<24>(0x864CFB);
  return crc_of<24>(bytes, table);
}

std::uint16_t crc16_ccitt(std::string_view bytes) {
  static constexpr auto table = crc_table<16>(0x1021);
  return static_cast<std::uint16_t>(crc_of<16>(bytes, table));
}

std::uint32_t crc32_novatel(std::string_view bytes) {
  static constexpr auto table = [] {
    constexpr std::uint32_t kReflected = 0xEDB88320;
    std::array<std::uint32_t, 256> remainders{};
    for (std::uint32_t byte = 0; byte < remainders.size(); ++byte) {
      std::uint32_t crc = byte;
      for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? kReflected : 0U);
      remainders[byte] = crc;
    }
    return remainders;
  }();
  std::uint32_t crc = 0;
  for (const char c : bytes) crc = crc >> 8 ^ table[(crc ^ static_cast<unsigned char>(c)) & 0xffU];
  return crc;
}

}  // namespace coast::io
