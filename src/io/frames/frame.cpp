#include "frame.hpp"

#include <fmt/format.h>

#include "../binary.hpp"
#include "../novatel/novatel_names.hpp"
#include "../sbf/sbf_names.hpp"
#include "../vectornav/vectornav_message.hpp"
#include "checksums.hpp"

namespace coast::io {

namespace {

using Verdict = FrameTrial::Verdict;

constexpr std::size_t kLongestSentence = 256;  // NMEA has 82; $PUBX and other sentences of one maker are longer
constexpr std::size_t kSentenceEnd = 5;        // '*', two digits, CR, LF

FrameTrial need(std::size_t size) {
  return {Verdict::kMore, size, 0, 0, 0};
}

std::uint8_t byte_at(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint8_t>(bytes[at]);
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/// Messages of UBX that are often recorded (u-blox F9 HPG and ZED-F9R interface descriptions).
struct UbxName {
  std::uint32_t id;
  std::string_view name;
};
constexpr std::array<UbxName, 32> kUbxNames = {
    {{0x0101, "NAV-POSECEF"},  {0x0102, "NAV-POSLLH"},  {0x0103, "NAV-STATUS"},    {0x0104, "NAV-DOP"},
     {0x0107, "NAV-PVT"},      {0x0111, "NAV-VELECEF"}, {0x0112, "NAV-VELNED"},    {0x0113, "NAV-HPPOSECEF"},
     {0x0114, "NAV-HPPOSLLH"}, {0x0120, "NAV-TIMEGPS"}, {0x0121, "NAV-TIMEUTC"},   {0x0122, "NAV-CLOCK"},
     {0x0135, "NAV-SAT"},      {0x0136, "NAV-COV"},     {0x013c, "NAV-RELPOSNED"}, {0x0143, "NAV-SIG"},
     {0x0161, "NAV-EOE"},      {0x0213, "RXM-SFRBX"},   {0x0214, "RXM-MEASX"},     {0x0215, "RXM-RAWX"},
     {0x0232, "RXM-RTCM"},     {0x0501, "ACK-ACK"},     {0x068b, "CFG-VALGET"},    {0x0a04, "MON-VER"},
     {0x0a09, "MON-HW"},       {0x0d01, "TIM-TP"},      {0x0d03, "TIM-TM2"},       {0x1002, "ESF-MEAS"},
     {0x1003, "ESF-RAW"},      {0x1010, "ESF-STATUS"},  {0x1014, "ESF-ALG"},       {0x1015, "ESF-INS"}}};

/// The three letters that tell a sentence: after the two of the talker; of one maker ("$PUBX", "$VNINS") those of the maker.
std::uint32_t sentence_id(std::string_view content) {
  const std::string_view address = content.substr(0, content.find(','));
  if (address.size() < 3) return 0;
  const std::string_view letters = address.size() == 5 && address[0] != 'P' && !address.starts_with("VN")
                                       ? address.substr(2)
                                       : address.substr(address[0] == 'P' ? 1 : 0, 3);
  if (letters.size() < 3) return 0;
  return static_cast<std::uint32_t>(byte_at(letters, 0)) << 16 | static_cast<std::uint32_t>(byte_at(letters, 1)) << 8 |
         byte_at(letters, 2);
}

}  // namespace

std::string_view name_of(Protocol protocol) {
  static constexpr std::array<std::string_view, kProtocols> names = {"UBX", "NMEA",    "RTCM",         "VectorNav",
                                                                     "SBF", "NovAtel", "NovAtel ASCII"};
  return names.at(static_cast<std::size_t>(protocol));
}

std::string frame_name(Protocol protocol, std::uint32_t id) {
  switch (protocol) {
    case Protocol::kUbx:
      for (const UbxName& known : kUbxNames)
        if (known.id == id) return fmt::format("UBX-{}", known.name);
      return fmt::format("UBX 0x{:02X} 0x{:02X}", id >> 8, id & 0xffU);
    case Protocol::kNmea:
      if (id == 0) return "NMEA";
      return fmt::format("NMEA {}{}{}", static_cast<char>(id >> 16), static_cast<char>(id >> 8 & 0xffU),
                         static_cast<char>(id & 0xffU));
    case Protocol::kRtcm3:
      return fmt::format("RTCM {}", id);
    case Protocol::kSbf:
      return sbf_block_name(id);
    case Protocol::kVectorNav:
      return fmt::format("VectorNav 0x{:02X}", id);
    case Protocol::kNovAtel:
    case Protocol::kNovAtelAscii:
      break;
  }
  const std::string_view name = novatel_log_name(id);
  return name.empty() ? fmt::format("{} {}", name_of(protocol), id) : fmt::format("{} {}", name_of(protocol), name);
}

/// Sync 0xB5 0x62, class, id, length of the payload, payload, checksum over class to payload (u-blox F9 interface description,
/// "UBX frame structure").
FrameTrial try_ubx(std::string_view bytes) {
  constexpr std::size_t kHead = 6, kFrame = 8;
  // The longest message, RXM-RAWX of 255 signals, has 8176 bytes. A bound keeps false beginnings in garbage cheap.
  constexpr std::size_t kLongestPayload = 8192 - kFrame;
  if (bytes.size() >= 2 && bytes[1] != '\x62') return {};
  if (bytes.size() < kHead) return need(kHead);
  const std::size_t payload = number_at<std::uint16_t>(bytes, 4);
  if (payload > kLongestPayload) return {};
  if (bytes.size() < kFrame + payload) return need(kFrame + payload);
  const std::uint16_t stated = number_at<std::uint16_t>(bytes, kHead + payload);
  if (fletcher8(bytes.substr(2, kHead - 2 + payload)) != stated) return {Verdict::kChecksum, 0, 0, 0, 0};
  const std::uint32_t id = static_cast<std::uint32_t>(byte_at(bytes, 2)) << 8 | byte_at(bytes, 3);
  return {Verdict::kFrame, kFrame + payload, id, kHead, payload};
}

/// '$', printable characters, '*', two hexadecimal digits of their exclusive or, CR LF (NMEA 0183).
FrameTrial try_nmea(std::string_view bytes) {
  std::uint8_t sum = 0;
  for (std::size_t i = 1; i < std::min(bytes.size(), kLongestSentence); ++i) {
    const char c = bytes[i];
    if (c == '*') {
      if (bytes.size() < i + kSentenceEnd) return need(i + kSentenceEnd);
      const int high = hex_digit(bytes[i + 1]), low = hex_digit(bytes[i + 2]);
      if (high < 0 || low < 0 || bytes[i + 3] != '\r' || bytes[i + 4] != '\n') return {};
      if (16 * high + low != sum) return {Verdict::kChecksum, 0, 0, 0, 0};
      return {Verdict::kFrame, i + kSentenceEnd, sentence_id(bytes.substr(1, i - 1)), 1, i - 1};
    }
    if (c < ' ' || c > '~' || c == '$') return {};
    sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  }
  return bytes.size() < kLongestSentence ? need(kLongestSentence) : FrameTrial{};
}

/// 0xD3, six zero bits and ten of the length, message, CRC-24Q (RTCM 10403). The message begins with its number, 12 bits.
FrameTrial try_rtcm3(std::string_view bytes) {
  constexpr std::size_t kHead = 3, kFrame = 6;
  if (bytes.size() >= 2 && (byte_at(bytes, 1) & 0xfcU) != 0) return {};
  if (bytes.size() < kHead) return need(kHead);
  const std::size_t message = number_at<std::uint16_t>(bytes, 1, true) & 0x3ffU;
  if (message < 2) return {};
  if (bytes.size() < kFrame + message) return need(kFrame + message);
  // Over a message with its CRC the remainder is zero.
  if (crc24q(bytes.substr(0, kFrame + message)) != 0) return {Verdict::kChecksum, 0, 0, 0, 0};
  return {Verdict::kFrame, kFrame + message, static_cast<std::uint32_t>(number_at<std::uint16_t>(bytes, kHead, true) >> 4),
          kHead, message};
}

/// Sync 0xFA, groups, fields of each, their contents, CRC-16 over all but the sync byte (VectorNav ICD).
FrameTrial try_vectornav(std::string_view bytes) {
  constexpr std::size_t kSync = 1, kCrc = 2;
  VectorNavMessage message;
  const VectorNavMessage::Head head = message.parse(bytes.substr(kSync));
  if (head == VectorNavMessage::Head::kUnknown) return {};
  const std::size_t size = kSync + message.size() + kCrc;
  if (bytes.size() < size) return need(size);
  if (crc16_ccitt(bytes.substr(kSync, message.size() + kCrc)) != 0) return {Verdict::kChecksum, 0, 0, 0, 0};
  return {Verdict::kFrame, size, message.groups(), kSync, message.size()};
}

/// '$', '@', CRC-16 of what follows it, number of the block with its revision in the upper three bits, length of the whole,
/// then time and contents (mosaic-X5 reference guide 4.14.10, 4.1.1 and 4.1.12). The payload begins with the time.
FrameTrial try_sbf(std::string_view bytes) {
  constexpr std::size_t kHead = 8, kAfterCrc = 4;
  constexpr std::size_t kShortest = 16;  // with the time, padded
  constexpr std::uint32_t kNumber = 0x1fff;
  if (bytes.size() >= 2 && bytes[1] != '@') return {};
  if (bytes.size() < kHead) return need(kHead);
  const std::size_t length = number_at<std::uint16_t>(bytes, 6);
  if (length < kShortest || length % 4 != 0) return {};
  if (bytes.size() < length) return need(length);
  if (crc16_ccitt(bytes.substr(kAfterCrc, length - kAfterCrc)) != number_at<std::uint16_t>(bytes, 2))
    return {Verdict::kChecksum, 0, 0, 0, 0};
  return {Verdict::kFrame, length, number_at<std::uint16_t>(bytes, 4) & kNumber, kHead, length - kHead};
}

}  // namespace coast::io
