#pragma once
// Messages that receivers send framed: what a frame is in each protocol. Private to the room.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace coast::io {

enum class Protocol : std::uint8_t { kUbx, kNmea, kRtcm3, kVectorNav, kSbf, kNovAtel, kNovAtelAscii };
inline constexpr std::size_t kProtocols = 7;

[[nodiscard]] std::string_view name_of(Protocol protocol);
/// "UBX-RXM-RAWX", "UBX 0x02 0x59" for a message without a name here, "NMEA GGA", "RTCM 1077", "VectorNav 0x0E",
/// "SBF MeasEpoch", "SBF 4999", "NovAtel RANGE", "NovAtel 1234", "NovAtel ASCII RANGE"
[[nodiscard]] std::string frame_name(Protocol protocol, std::uint32_t id);

/// One message. UBX: the id is class * 256 + id; NMEA: the three letters of the sentence, or PUB of $PUBX; RTCM 3: the message
/// number; VectorNav: the byte of the groups, with which the payload begins; SBF: the number of the block without its revision;
/// NovAtel: the message ID, and the payload begins with the first byte of the frame.
struct MessageFrame {
  Protocol protocol = Protocol::kUbx;
  std::uint32_t id = 0;
  std::string_view payload;    ///< without frame, length and checksum
  std::uint64_t position = 0;  ///< of the frame's first byte in the decompressed file
};

/// What bytes that begin like a frame are.
struct FrameTrial {
  enum class Verdict : std::uint8_t {
    kFrame,     ///< whole and right
    kNone,      ///< none of this protocol
    kChecksum,  ///< a frame with a wrong checksum
    kMore,      ///< undecided without `size` bytes
  };
  Verdict verdict = Verdict::kNone;
  std::size_t size = 0;  ///< of the frame, or of the bytes needed
  std::uint32_t id = 0;
  std::size_t payload_at = 0, payload_size = 0;
};

/// @param bytes from the first byte of a possible frame on, at least one byte
using FrameRule = FrameTrial (*)(std::string_view bytes);

/// No frame of any protocol is longer, so that `kMore` never asks for more.
inline constexpr std::size_t kLongestFrame = 65536;

[[nodiscard]] FrameTrial try_ubx(std::string_view bytes);
[[nodiscard]] FrameTrial try_nmea(std::string_view bytes);
[[nodiscard]] FrameTrial try_rtcm3(std::string_view bytes);
[[nodiscard]] FrameTrial try_vectornav(std::string_view bytes);
[[nodiscard]] FrameTrial try_sbf(std::string_view bytes);
[[nodiscard]] FrameTrial try_novatel(std::string_view bytes);
[[nodiscard]] FrameTrial try_novatel_ascii(std::string_view bytes);

/// A protocol with the byte that its frames begin with. Of several with the same byte, the first whose rule does not say kNone
/// decides.
struct FrameKind {
  Protocol protocol = Protocol::kUbx;
  char first = 0;
  FrameRule rule = nullptr;
};

/// What may be in a log of a u-blox receiver: UBX, and NMEA and RTCM 3 between.
inline constexpr std::array<FrameKind, 3> kUbxLog{
    {{Protocol::kUbx, '\xb5', try_ubx}, {Protocol::kNmea, '$', try_nmea}, {Protocol::kRtcm3, '\xd3', try_rtcm3}}};
/// Of a base station or a caster: RTCM 3, and messages of the receiver between.
inline constexpr std::array<FrameKind, 3> kRtcmLog = kUbxLog;
/// Of a VectorNav: its binary output, and its ASCII output, which is framed like NMEA.
inline constexpr std::array<FrameKind, 2> kVectorNavLog{
    {{Protocol::kVectorNav, '\xfa', try_vectornav}, {Protocol::kNmea, '$', try_nmea}}};
/// Of a Septentrio receiver: SBF, and NMEA and RTCM 3 between. Replies to commands ("$R: ..") are no frames.
inline constexpr std::array<FrameKind, 3> kSbfLog{
    {{Protocol::kSbf, '$', try_sbf}, {Protocol::kNmea, '$', try_nmea}, {Protocol::kRtcm3, '\xd3', try_rtcm3}}};
/// Of a NovAtel receiver: binary logs, ASCII logs with long and short headers, and NMEA and RTCM 3 between.
inline constexpr std::array<FrameKind, 5> kNovAtelLog{{{Protocol::kNovAtel, '\xaa', try_novatel},
                                                       {Protocol::kNovAtelAscii, '#', try_novatel_ascii},
                                                       {Protocol::kNovAtelAscii, '%', try_novatel_ascii},
                                                       {Protocol::kNmea, '$', try_nmea},
                                                       {Protocol::kRtcm3, '\xd3', try_rtcm3}}};

}  // namespace coast::io
