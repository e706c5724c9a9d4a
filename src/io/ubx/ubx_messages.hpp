#pragma once
// UBX messages that are read, and what states the time in them. Fields: u-blox F9 HPG interface description (UBX-22008968), and
// for sensors that of ZED-F9R. Private to the room.

#include <cstdint>
#include <optional>

#include "../frames/frame_stream.hpp"
#include "coast/geo/time.hpp"

namespace coast::io {

namespace ubx {
inline constexpr std::uint32_t kNavPvt = 0x0107;
inline constexpr std::uint32_t kNavHpPosLlh = 0x0114;
inline constexpr std::uint32_t kNavTimeGps = 0x0120;
inline constexpr std::uint32_t kNavCov = 0x0136;
inline constexpr std::uint32_t kRxmSfrbx = 0x0213;
inline constexpr std::uint32_t kRxmRawx = 0x0215;
inline constexpr std::uint32_t kMonVer = 0x0a04;
inline constexpr std::uint32_t kTimTm2 = 0x0d03;
inline constexpr std::uint32_t kEsfMeas = 0x1002;
inline constexpr std::uint32_t kEsfRaw = 0x1003;
}  // namespace ubx

/// GPS time of NAV-PVT: second of week by iTOW, which knows no leap seconds, its fraction below a millisecond by `nano`, the
/// week by the date. None while date or time are not valid.
[[nodiscard]] std::optional<geo::GpsTime> pvt_time(std::string_view payload);
/// None while the receiver does not know the week.
[[nodiscard]] std::optional<geo::GpsTime> rawx_time(std::string_view payload);
/// The time that a message of any kind states, with its week.
[[nodiscard]] std::optional<geo::GpsTime> stated_time(const MessageFrame& frame);
/// The first time stated in a file; none if no message states one.
[[nodiscard]] std::optional<geo::GpsTime> first_stated_time(const std::filesystem::path& file);

/// Damage of the file, and the messages that no reader of UBX uses, by name and number.
[[nodiscard]] record::Events ubx_file_events(const FrameCensus& census, const std::string& file);

/// A message of UBX has been found whole in the first bytes of a file.
[[nodiscard]] bool begins_as_ubx(std::string_view head);

}  // namespace coast::io
