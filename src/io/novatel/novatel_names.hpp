#pragma once
// Logs of NovAtel receivers by message ID. Private to the room.

#include <cstdint>
#include <string_view>

namespace coast::io {

namespace novatel {
inline constexpr std::uint32_t kGpsEphem = 7;
inline constexpr std::uint32_t kIonUtc = 8;
inline constexpr std::uint32_t kRawGpsSubframe = 25;
inline constexpr std::uint32_t kRawEphem = 41;
inline constexpr std::uint32_t kBestPos = 42;
inline constexpr std::uint32_t kRange = 43;
inline constexpr std::uint32_t kPsrPos = 47;
inline constexpr std::uint32_t kBestVel = 99;
inline constexpr std::uint32_t kPsrVel = 100;
inline constexpr std::uint32_t kRangeCmp = 140;
inline constexpr std::uint32_t kRtkPos = 141;
inline constexpr std::uint32_t kRtkVel = 216;
inline constexpr std::uint32_t kMarkTime = 231;
inline constexpr std::uint32_t kRawImu = 268;
inline constexpr std::uint32_t kRawImuS = 325;
inline constexpr std::uint32_t kInsPva = 507;
inline constexpr std::uint32_t kInsPvaS = 508;
inline constexpr std::uint32_t kBestGpsPos = 423;
inline constexpr std::uint32_t kBestGpsVel = 506;
inline constexpr std::uint32_t kSetImuType = 569;
inline constexpr std::uint32_t kMark2Time = 616;
inline constexpr std::uint32_t kGloEphemeris = 723;
inline constexpr std::uint32_t kCorrImuData = 812;
inline constexpr std::uint32_t kCorrImuDataS = 813;
inline constexpr std::uint32_t kMark1Pva = 1067;
inline constexpr std::uint32_t kMark2Pva = 1068;
inline constexpr std::uint32_t kMark3Time = 1075;
inline constexpr std::uint32_t kMark4Time = 1076;
inline constexpr std::uint32_t kMark3Pva = 1118;
inline constexpr std::uint32_t kMark4Pva = 1119;
inline constexpr std::uint32_t kGalEphemeris = 1122;
inline constexpr std::uint32_t kMark1Time = 1130;
inline constexpr std::uint32_t kRangeCmp2 = 1273;
inline constexpr std::uint32_t kGalInavEphemeris = 1309;
inline constexpr std::uint32_t kGalFnavEphemeris = 1310;
inline constexpr std::uint32_t kQzssRawSubframe = 1330;
inline constexpr std::uint32_t kQzssEphemeris = 1336;
inline constexpr std::uint32_t kImuRateCorrImuS = 1362;
inline constexpr std::uint32_t kBestGnssPos = 1429;
inline constexpr std::uint32_t kBestGnssVel = 1430;
inline constexpr std::uint32_t kRawImuX = 1461;
inline constexpr std::uint32_t kRawImuSX = 1462;
inline constexpr std::uint32_t kInsPvaX = 1465;
inline constexpr std::uint32_t kPppPos = 1538;
inline constexpr std::uint32_t kPppVel = 1539;
inline constexpr std::uint32_t kBdsEphemeris = 1696;
inline constexpr std::uint32_t kInsConfig = 1945;
inline constexpr std::uint32_t kRangeCmp4 = 2050;
inline constexpr std::uint32_t kRangeCmp5 = 2537;
}  // namespace novatel

/// "RANGE" of 43; empty for a message that is not listed here.
[[nodiscard]] std::string_view novatel_log_name(std::uint32_t id);
/// 43 of "RANGE"; 0 for a name that is not listed here.
[[nodiscard]] std::uint32_t novatel_log_id(std::string_view name);
/// A reader of coast uses this message.
[[nodiscard]] bool reads_novatel_log(std::uint32_t id);

}  // namespace coast::io
