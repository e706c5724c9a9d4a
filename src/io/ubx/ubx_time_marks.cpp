// UBX-TIM-TM2: edges at the input EXTINT (u-blox F9 HPG interface description).

#include <fmt/format.h>

#include <algorithm>

#include "../binary.hpp"
#include "../counted.hpp"
#include "coast/record/error.hpp"
#include "ubx_messages.hpp"
#include "ubx_readers.hpp"

namespace coast::io {

namespace {

constexpr unsigned kNewFalling = 1U << 2, kTimeValid = 1U << 6, kNewRising = 1U << 7;
enum class TimeBase { kReceiver, kGnss, kUtc };

std::optional<geo::GpsTime> edge_time(std::string_view b, std::size_t week_at, std::size_t tow_at, TimeBase base) {
  constexpr std::uint32_t kWeekMs = 604'800'000, kMillisecond = 1'000'000;  // ms, ns
  const auto ms = number_at<std::uint32_t>(b, tow_at), ns = number_at<std::uint32_t>(b, tow_at + 4);
  const int week = number_at<std::uint16_t>(b, week_at);
  constexpr int kMostWeeks = 9999;
  if (ms >= kWeekMs || ns >= kMillisecond || week > kMostWeeks) return std::nullopt;
  const geo::GpsTime t = geo::GpsTime::from_week(week, 1e-3 * ms) + 1e-9 * ns;
  return base == TimeBase::kUtc ? t + geo::leap_seconds(t) : t;
}

}  // namespace

record::TimeMarkRecording read_ubx_time_marks(const std::filesystem::path& file) {
  constexpr std::size_t kSize = 28;
  constexpr std::size_t kRisingWeek = 4, kFallingWeek = 6, kRisingTow = 8, kFallingTow = 16;
  FrameStream stream(file, kUbxLog);
  record::TimeMarkRecording recording;
  recording.source = stream.name();
  long left_out = 0;
  MessageFrame frame;
  while (stream.next(frame)) {
    if (frame.protocol != Protocol::kUbx || frame.id != ubx::kTimTm2 || frame.payload.size() < kSize) continue;
    const std::string_view b = frame.payload;
    const unsigned flags = number_at<std::uint8_t>(b, 1);
    const auto base = static_cast<TimeBase>(flags >> 3 & 3U);
    const bool usable = (flags & kTimeValid) != 0 && (base == TimeBase::kGnss || base == TimeBase::kUtc);
    for (const bool rising : {true, false}) {
      if ((flags & (rising ? kNewRising : kNewFalling)) == 0) continue;
      const auto t = edge_time(b, rising ? kRisingWeek : kFallingWeek, rising ? kRisingTow : kFallingTow, base);
      if (usable && t)
        recording.marks.push_back({*t, 1e-9 * number_at<std::uint32_t>(b, 24), number_at<std::uint8_t>(b, 0),
                                   rising ? record::Edge::kRising : record::Edge::kFalling, number_at<std::uint16_t>(b, 2)});
      else
        ++left_out;
    }
  }
  recording.events = ubx_file_events(stream.census(), recording.source);
  if (recording.marks.empty())
    throw InputError(
        {recording.source, 0, fmt::format("no time mark{}", left_out > 0 ? " with a valid GNSS time" : ""), "UBX-TIM-TM2", ""});
  std::ranges::stable_sort(recording.marks, {}, &record::TimeMark::t);
  add_counted(recording.events, recording.source, {left_out},
              {"time_mark_invalid", "time mark", "time marks", "without a valid GNSS time left out"});
  return recording;
}

}  // namespace coast::io
