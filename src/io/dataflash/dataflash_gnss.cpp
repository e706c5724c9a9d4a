// Positions of DataFlash logs: GPS, with the accuracies and the height of the geoid of GPA (AP_GPS's LogStructure). Until
// version 4.0 further receivers are GPS2 and GPA2, since then they have a number in the field I.

#include "dataflash_gnss.hpp"

#include <cmath>
#include <cstdlib>

#include "../receiver_positions.hpp"
#include "coast/geo/units.hpp"
#include "dataflash_readers.hpp"

namespace coast::io {

namespace {

/// Number of the receiver; none for other messages.
std::optional<int> receiver_of(const DataflashMessage& message, std::string_view prefix) {
  const std::string& name = message.format->name;
  if (!name.starts_with(prefix) || name.size() > prefix.size() + 1) return std::nullopt;
  if (name.size() == prefix.size()) return message.instance();
  const char digit = name.back();
  return digit >= '2' && digit <= '9' ? std::optional(digit - '1') : std::nullopt;
}

std::optional<geo::GpsTime> dataflash_time(const DataflashMessage& message) {
  constexpr std::int64_t kFirstWeek = 1000, kLastWeek = 6260, kWeek = 604'800'000;  // years 1999 to 2100; ms
  auto week = message.integer("GWk"), ms = message.integer("GMS");
  if (!week) week = message.integer("Week");  // before 2015
  if (!ms && week && !message.integer("TimeUS")) ms = message.integer("TimeMS");
  if (!week || !ms || *week < kFirstWeek || *week > kLastWeek || *ms < 0 || *ms >= kWeek) return std::nullopt;
  return geo::GpsTime::from_week(static_cast<int>(*week), 1e-3 * static_cast<double>(*ms));
}

std::optional<DataflashPosition> dataflash_position(const DataflashMessage& message) {
  const auto boot = message.boot_us("TimeUS", "T");
  const auto latitude = message.number("Lat"), longitude = message.number("Lng"), height = message.number("Alt");
  if (!boot || !latitude || !longitude || !height) return std::nullopt;
  DataflashPosition p;
  p.boot_us = *boot;
  p.t = dataflash_time(message);
  p.status = static_cast<int>(message.integer("Status").value_or(0));
  p.place = {*latitude * geo::kDegree, *longitude * geo::kDegree, *height};
  p.satellites = static_cast<int>(message.integer("NSats").value_or(0));
  const double speed = message.number("Spd").value_or(0.0), course = message.number("GCrs").value_or(0.0) * geo::kDegree;
  p.velocity_n = {speed * std::cos(course), speed * std::sin(course), message.number("VZ").value_or(0.0)};
  return p;
}

/// GPA is written behind GPS, with the same time.
void add_accuracy(const DataflashMessage& message, DataflashPosition& p) {
  p.horizontal_sd = message.number("HAcc").value_or(0.0);
  p.vertical_sd = message.number("VAcc").value_or(0.0);
  p.speed_sd = message.number("SAcc").value_or(0.0);
  p.vertical_speed = message.integer("VV").value_or(1) != 0;
  // Und is mean sea level over the ellipsoid with the sign turned: the height above it minus that above the ellipsoid. Exactly
  // 0 where the receiver does not say it. AEl, since 4.6, is the height above the ellipsoid itself.
  constexpr double kHighestGeoid = 120.0;
  const auto und = message.number("Und"), ellipsoidal = message.number("AEl");
  if (und && *und != 0.0 && std::abs(*und) < kHighestGeoid) p.geoid = -*und;
  if (ellipsoidal && std::abs(*ellipsoidal - p.place.height) < kHighestGeoid) p.geoid = *ellipsoidal - p.place.height;
}

ReceiverPosition stated_by_dataflash(const DataflashPosition& p, std::optional<double> geoid) {
  const auto quality = quality_of_fix_type(p.status);
  ReceiverPosition position;
  position.t = p.t;
  position.solved = quality.has_value();
  position.r_ea_e = ecef_if_on_earth({p.place.latitude, p.place.longitude, p.place.height + geoid.value_or(0.0)});
  position.position_cov_n = position_covariance(p.horizontal_sd, p.vertical_sd);
  if (p.vertical_speed) position.v_ea_n = p.velocity_n;
  position.velocity_cov_n = velocity_covariance(p.speed_sd);
  position.quality = quality.value_or(record::FixQuality::kUnknown);
  position.satellites = p.satellites;
  return position;
}

}  // namespace

void DataflashPositions::take(const DataflashMessage& message) {
  if (const auto receiver = receiver_of(message, "GPS")) {
    if (const auto p = dataflash_position(message)) receivers_[*receiver].push_back(*p);
  } else if (const auto accuracy_of = receiver_of(message, "GPA")) {
    auto& positions = receivers_[*accuracy_of];
    if (!positions.empty() && message.boot_us("TimeUS", "T") == positions.back().boot_us)
      add_accuracy(message, positions.back());
  }
}

std::span<const DataflashPosition> DataflashPositions::first() const {
  for (const auto& [receiver, positions] : receivers_)
    if (!positions.empty()) return positions;
  return {};
}

record::GnssRecording read_dataflash_gnss(const GnssFileOptions& options, Format::Near) {
  DataflashStream stream(options.file);
  DataflashPositions positions;
  DataflashMessage message;
  while (stream.next(message)) positions.take(message);
  ReceiverPositions fixes(options, stream.name());
  Counted at_sea_level;
  for (const DataflashPosition& p : positions.first()) {
    const auto geoid = p.geoid ? p.geoid : options.position.geoid_height;
    if (fixes.take(stated_by_dataflash(p, geoid)) && !geoid) at_sea_level.add(p.t);
  }
  record::GnssRecording recording =
      fixes.finish(stream.events(), {.positions = {stream.name(), 0, "a log without positions", "messages GPS", ""},
                                     .for_time = "",
                                     .for_accuracy = "Give `sd_m: [n, e, d]` beside the file."});
  add_counted(recording.events, stream.name(), at_sea_level,
              {"msl_height", "position", "positions",
               "with a height above mean sea level that was used as it is: absolute heights are off by that of the geoid (give "
               "`geoid_height_m`)"});
  return recording;
}

}  // namespace coast::io
