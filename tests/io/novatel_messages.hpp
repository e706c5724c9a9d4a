#pragma once
// Logs as a NovAtel receiver writes them, binary and ASCII, from one list of fields. Shares no code with the readers.

#include <cmath>
#include <cstdio>
#include <string>

#include "io/receiver_messages.hpp"

namespace coast::test {

/// A body in both forms.
class NovAtelBody {
 public:
  NovAtelBody& f64(double value) { return add(Bytes().r8(value), printed("%.17g", value)); }
  NovAtelBody& f32(float value) { return add(Bytes().r4(value), printed("%.9g", static_cast<double>(value))); }
  NovAtelBody& u32(std::uint32_t value) { return add(Bytes().u4(value), std::to_string(value)); }
  NovAtelBody& i32(std::int32_t value) { return add(Bytes().i4(value), std::to_string(value)); }
  NovAtelBody& u16(unsigned value) { return add(Bytes().u2(value), std::to_string(value)); }
  NovAtelBody& u8(unsigned value) { return add(Bytes().u1(value), std::to_string(value)); }
  NovAtelBody& hex32(std::uint32_t value) { return add(Bytes().u4(value), digits(Bytes().u4(value).str(), true)); }
  NovAtelBody& hex8(unsigned value) { return add(Bytes().u1(value), digits(Bytes().u1(value).str(), true)); }
  NovAtelBody& word(const std::string& name, std::uint32_t number) { return add(Bytes().u4(number), name); }
  NovAtelBody& bytes(const std::string& value) { return add(Bytes().text(value), digits(value, false)); }
  NovAtelBody& text(const std::string& four) { return add(Bytes().text(four), "\"" + four + "\""); }

  std::string binary, ascii;

 private:
  NovAtelBody& add(const Bytes& bytes, const std::string& field) {
    binary += bytes.str();
    ascii += (ascii.empty() ? "" : ",") + field;
    return *this;
  }
  static std::string printed(const char* form, double value) {
    char text[64];
    std::snprintf(text, sizeof text, form, value);
    return text;
  }
  static std::string digits(const std::string& bytes, bool number) {
    std::string all;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      char two[3];
      const std::size_t at = number ? bytes.size() - 1 - i : i;
      std::snprintf(two, sizeof two, "%02x", static_cast<unsigned>(static_cast<unsigned char>(bytes[at])));
      all += two;
    }
    return all;
  }
};

/// "32-bit CRC" of the manual: the lowest bit first.
inline std::uint32_t novatel_crc(const std::string& bytes) {
  std::uint32_t crc = 0;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1 ^ 0xEDB88320U : crc >> 1;
  }
  return crc;
}

/// Where and when a log is from.
struct NovAtelHead {
  unsigned week = 2200;
  double seconds = 300'000.0;
  unsigned status = 180;  ///< FINESTEERING
  std::string status_word = "FINESTEERING";
  unsigned type = 0;  ///< 1: second antenna
};

inline std::string novatel_binary(unsigned id, const NovAtelBody& body, const NovAtelHead& head = {}) {
  Bytes b;
  b.text("\xaa\x44\x12").u1(28).u2(id).u1(head.type).u1(32).u2(static_cast<unsigned>(body.binary.size())).u2(0).u1(100);
  b.u1(head.status).u2(head.week).u4(static_cast<std::uint32_t>(std::lround(head.seconds * 1000.0))).u4(0).u2(0).u2(16000);
  b.text(body.binary);
  return b.str() + Bytes().u4(novatel_crc(b.str())).str();
}

inline std::string novatel_short(unsigned id, const NovAtelBody& body, const NovAtelHead& head = {}) {
  Bytes b;
  b.text("\xaa\x44\x13").u1(static_cast<unsigned>(body.binary.size())).u2(id).u2(head.week);
  b.u4(static_cast<std::uint32_t>(std::lround(head.seconds * 1000.0))).text(body.binary);
  return b.str() + Bytes().u4(novatel_crc(b.str())).str();
}

inline std::string novatel_line(char first, const std::string& content) {
  char crc[16];
  std::snprintf(crc, sizeof crc, "*%08x\r\n", static_cast<unsigned>(novatel_crc(content)));
  return first + content + crc;
}

inline std::string novatel_ascii(const std::string& name, const NovAtelBody& body, const NovAtelHead& head = {}) {
  char text[128];
  std::snprintf(text, sizeof text, ",COM1,0,85.5,%s,%u,%.3f,02000020,4444,16000;", head.status_word.c_str(), head.week,
                head.seconds);
  return novatel_line('#', name + text + body.ascii);
}

inline std::string novatel_short_ascii(const std::string& name, const NovAtelBody& body, const NovAtelHead& head = {}) {
  char text[64];
  std::snprintf(text, sizeof text, ",%u,%.3f;", head.week, head.seconds);
  return novatel_line('%', name + text + body.ascii);
}

}  // namespace coast::test
