#pragma once
// Receivers' messages as a receiver writes them: bytes put together and framed. Shares no code with the readers.

#include <cstdint>
#include <string>
#include <type_traits>

namespace coast::test {

/// Numbers one after another, little endian.
class Bytes {
 public:
  template <class T>
  Bytes& put(std::type_identity_t<T> value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Bytes& u1(unsigned value) { return put<std::uint8_t>(static_cast<std::uint8_t>(value)); }
  Bytes& u2(unsigned value) { return put<std::uint16_t>(static_cast<std::uint16_t>(value)); }
  Bytes& u4(std::uint32_t value) { return put<std::uint32_t>(value); }
  Bytes& i1(int value) { return put<std::int8_t>(static_cast<std::int8_t>(value)); }
  Bytes& i4(std::int32_t value) { return put<std::int32_t>(value); }
  Bytes& r4(float value) { return put<float>(value); }
  Bytes& r8(double value) { return put<double>(value); }
  Bytes& zeros(std::size_t number) {
    bytes_.append(number, '\0');
    return *this;
  }
  Bytes& text(const std::string& more) {
    bytes_ += more;
    return *this;
  }
  [[nodiscard]] const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Bit by bit, as the standards define it.
inline std::uint32_t crc_bit_by_bit(const std::string& bytes, std::uint32_t polynomial, int bits) {
  const std::uint32_t mask = bits == 32 ? ~0U : (1U << bits) - 1U;
  std::uint32_t crc = 0;
  for (const char c : bytes)
    for (int bit = 7; bit >= 0; --bit) {
      const std::uint32_t in = static_cast<unsigned char>(c) >> bit & 1U;
      const std::uint32_t out = crc >> (bits - 1) & 1U;
      crc = (crc << 1 & mask) ^ (in != out ? polynomial : 0U);
    }
  return crc;
}

inline std::string ubx(unsigned message_class, unsigned id, const std::string& payload) {
  const std::string body = Bytes().u1(message_class).u1(id).u2(static_cast<unsigned>(payload.size())).text(payload).str();
  std::uint8_t a = 0, b = 0;
  for (const char c : body) {
    a = static_cast<std::uint8_t>(a + static_cast<unsigned char>(c));
    b = static_cast<std::uint8_t>(b + a);
  }
  return "\xb5\x62" + body + Bytes().u1(a).u1(b).str();
}

inline std::string nmea(const std::string& content) {
  unsigned sum = 0;
  for (const char c : content) sum ^= static_cast<unsigned char>(c);
  const char* digits = "0123456789ABCDEF";
  return "$" + content + "*" + digits[sum >> 4] + digits[sum & 15U] + "\r\n";
}

inline std::string rtcm3(unsigned number, std::size_t bytes) {
  std::string message(bytes, '\x5a');
  message[0] = static_cast<char>(number >> 4);
  message[1] = static_cast<char>((number & 15U) << 4);
  const std::string body = Bytes().u1(0xd3).u1(static_cast<unsigned>(bytes >> 8)).u1(bytes & 255U).text(message).str();
  const std::uint32_t crc = crc_bit_by_bit(body, 0x864CFB, 24);
  return body + Bytes().u1(crc >> 16).u1(crc >> 8 & 255U).u1(crc & 255U).str();
}

}  // namespace coast::test
