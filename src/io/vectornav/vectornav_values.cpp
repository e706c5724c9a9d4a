#include "vectornav_values.hpp"

#include <fmt/format.h>

#include "../receiver_positions.hpp"
#include "coast/geo/units.hpp"
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

/// Of fields with latitude, longitude (deg) and height, and with ECEF coordinates.
std::optional<Eigen::Vector3d> position_of(const std::optional<std::string_view>& lla,
                                           const std::optional<std::string_view>& ecef) {
  constexpr double kNearest = 5e6, kFarthest = 8e6;  // m
  if (lla) {
    const Eigen::Vector3d p = vector_at<double>(*lla);
    if (p.isZero(0.0)) return std::nullopt;  // before the first fix
    return ecef_if_on_earth({p.x() * geo::kDegree, p.y() * geo::kDegree, p.z()});
  }
  if (ecef) {
    const Eigen::Vector3d r = vector_at<double>(*ecef);
    if (r.norm() > kNearest && r.norm() < kFarthest) return r;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Eigen::Vector3d> vectornav_position(const VectorNavMessage& message, VectorNavGroup group) {
  return position_of(message.field(group, 5), message.field(group, 6));
}

std::optional<Eigen::Vector3d> vectornav_position(const VectorNavMessage& message) {
  using enum VectorNavGroup;
  for (const VectorNavGroup group : {kGnss1, kGnss2})
    if (auto r = vectornav_position(message, group)) return r;
  return position_of(message.field(kIns, 1), message.field(kIns, 2));
}

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
