#include "vectornav_values.hpp"

#include <fmt/format.h>

#include "vectornav_readers.hpp"
#include "vectornav_stream.hpp"

namespace coast::io {

namespace {

constexpr std::uint64_t kWeekNanoseconds = 604'800'000'000'000;
constexpr std::uint64_t kMostWeeks = 9999;

std::optional<geo::GpsTime> since_epoch(std::uint64_t nanoseconds) {
  if (nanoseconds < kWeekNanoseconds || nanoseconds > kMostWeeks * kWeekNanoseconds) return std::nullopt;
  return geo::GpsTime::from_nanoseconds(static_cast<std::int64_t>(nanoseconds));
}

}  // namespace

std::optional<geo::GpsTime> week_and_nanoseconds(std::uint16_t week, std::uint64_t nanoseconds) {
  if (nanoseconds >= kWeekNanoseconds) return std::nullopt;
  return since_epoch(week * kWeekNanoseconds + nanoseconds);
}

std::optional<geo::GpsTime> measurement_time(const VectorNavMessage& message) {
  using enum VectorNavGroup;
  constexpr int kTimeAndDate = 3;
  if (const auto status = message.field(kTime, 9); status && ((*status)[0] & kTimeAndDate) != kTimeAndDate) return std::nullopt;
  if (const auto t = message.field(kTime, 1)) return since_epoch(number_at<std::uint64_t>(*t, 0));
  if (const auto t = message.field(kCommon, 1)) return since_epoch(number_at<std::uint64_t>(*t, 0));
  const auto tow = message.field(kTime, 2), week = message.field(kTime, 3);
  if (!tow || !week) return std::nullopt;
  return week_and_nanoseconds(number_at<std::uint16_t>(*week, 0), number_at<std::uint64_t>(*tow, 0));
}

record::Events vectornav_file_events(const FrameCensus& census, const std::string& file) {
  record::Events events = census.events(file);
  long others = 0;
  for (const auto& [key, number] : census.frames) others += key.first == Protocol::kVectorNav ? 0 : number;
  if (others > 0)
    events.push_back({record::Event::Severity::kInfo, "messages_not_read",
                      fmt::format("{}: {} lines of text that coast does not read", file, others), std::nullopt, others});
  return events;
}

bool begins_as_vectornav(std::string_view head) {
  for (std::size_t at = head.find('\xfa'); at != std::string_view::npos; at = head.find('\xfa', at + 1))
    if (try_vectornav(head.substr(at)).verdict == FrameTrial::Verdict::kFrame) return true;
  return VectorNavRecords::begins_in(head);
}

}  // namespace coast::io
