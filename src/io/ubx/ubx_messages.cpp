#include "ubx_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "../binary.hpp"
#include "../ephemerides.hpp"

namespace coast::io {

namespace {

constexpr double kUbxWeek = 604800.0;               // s
constexpr int kLargestUbxWeek = 9999;               // beyond, not a week but damage that the checksum has missed
constexpr std::uint32_t kLargestTow = 604'800'000;  // ms

std::optional<geo::GpsTime> week_and_second(int week, double sow) {
  if (week <= 0 || week > kLargestUbxWeek || !(sow >= 0.0 && sow < kUbxWeek)) return std::nullopt;
  return geo::GpsTime::from_week(week, sow);
}

/// NAV-TIMEGPS: iTOW [ms], its fraction [ns], week, leap seconds, validity of second, week, leap seconds.
std::optional<geo::GpsTime> timegps_time(std::string_view payload) {
  constexpr std::size_t kSize = 16;
  if (payload.size() < kSize || (payload[11] & 3) != 3) return std::nullopt;
  const double sow = 1e-3 * number_at<std::uint32_t>(payload, 0) + 1e-9 * number_at<std::int32_t>(payload, 4);
  return week_and_second(number_at<std::int16_t>(payload, 8), sow);
}

}  // namespace

std::optional<geo::GpsTime> pvt_time(std::string_view payload) {
  constexpr std::size_t kSize = 84;  // 92 since protocol 15
  constexpr int kDateAndTime = 3;
  if (payload.size() < kSize || (payload[11] & kDateAndTime) != kDateAndTime) return std::nullopt;
  const std::uint32_t tow = number_at<std::uint32_t>(payload, 0);
  if (tow >= kLargestTow) return std::nullopt;
  const auto byte = [&](std::size_t at) { return static_cast<int>(number_at<std::uint8_t>(payload, at)); };
  try {
    const geo::GpsTime date = geo::GpsTime::from_utc(
        {number_at<std::uint16_t>(payload, 4), byte(6), byte(7), byte(8), byte(9), static_cast<double>(byte(10))});
    const double nano = number_at<std::int32_t>(payload, 16);
    constexpr double kMillisecond = 1e6;  // ns
    return nearest_second_of_week(date, 1e-3 * tow) + 1e-9 * std::remainder(nano, kMillisecond);
  } catch (const std::invalid_argument&) {
    return std::nullopt;  // no date
  }
}

std::optional<geo::GpsTime> rawx_time(std::string_view payload) {
  constexpr std::size_t kHead = 16;
  if (payload.size() < kHead) return std::nullopt;
  return week_and_second(number_at<std::uint16_t>(payload, 8), number_at<double>(payload, 0));
}

std::optional<geo::GpsTime> stated_time(const MessageFrame& frame) {
  if (frame.protocol != Protocol::kUbx) return std::nullopt;
  if (frame.id == ubx::kNavPvt) return pvt_time(frame.payload);
  if (frame.id == ubx::kRxmRawx) return rawx_time(frame.payload);
  if (frame.id == ubx::kNavTimeGps) return timegps_time(frame.payload);
  return std::nullopt;
}

std::optional<geo::GpsTime> first_stated_time(const std::filesystem::path& file) {
  FrameStream stream(file, kUbxLog);
  MessageFrame frame;
  while (stream.next(frame))
    if (const auto t = stated_time(frame)) return t;
  return std::nullopt;
}

record::Events ubx_file_events(const FrameCensus& census, const std::string& file) {
  static constexpr std::array kRead = {ubx::kNavPvt,  ubx::kNavHpPosLlh, ubx::kNavTimeGps, ubx::kNavCov,  ubx::kRxmSfrbx,
                                       ubx::kRxmRawx, ubx::kMonVer,      ubx::kTimTm2,     ubx::kEsfMeas, ubx::kEsfRaw};
  return file_events(census, file, [](Protocol protocol, std::uint32_t id) {
    return protocol == Protocol::kUbx && std::ranges::find(kRead, id) != kRead.end();
  });
}

bool begins_as_ubx(std::string_view head) {
  for (std::size_t at = head.find("\xb5\x62"); at != std::string_view::npos; at = head.find("\xb5\x62", at + 1)) {
    const FrameTrial trial = try_ubx(head.substr(at));
    // A long first message may go on beyond what has been read of the file; then its beginning has to do.
    if (trial.verdict == FrameTrial::Verdict::kFrame || (trial.verdict == FrameTrial::Verdict::kMore && at == 0)) return true;
  }
  return false;
}

}  // namespace coast::io
