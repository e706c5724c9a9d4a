#include "position.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "text.hpp"

namespace coast::io {

namespace {

// All vehicles are within these bounds of the ellipsoid; outside, columns or units are wrong.
constexpr double kLowest = -12000.0;
constexpr double kHighest = 2.0e6;

void check_zone(const config::Node& node, std::string_view text, int zone) {
  if (zone < 1 || zone > 60)
    throw node.error(text, "a zone from 1 to 60 with N or S, e.g. 18N (north, not the latitude band)", "");
}

geo::Geodetic origin_from(const config::Node& node) {
  const Eigen::Vector3d v = node.vector3();
  if (std::abs(v.x()) > 90.0 || std::abs(v.y()) > 360.0)
    throw node.error("an origin out of range", "[latitude_deg, longitude_deg, height_m]", "");
  return {v.x() * geo::kDegree, v.y() * geo::kDegree, v.z()};
}

}  // namespace

PositionOptions PositionOptions::from(const config::Node& map) {
  PositionOptions o;
  o.frame = static_cast<Frame>(map.choice("frame", {"geodetic", "ecef", "utm", "ned", "enu"}, 0));
  if (const auto zone = map.find("utm_zone")) {
    const std::string text = zone->text();
    const char hemisphere = text.empty() ? ' ' : text.back();
    if (hemisphere != 'N' && hemisphere != 'S') check_zone(*zone, text, 0);
    const auto number = parse_number(std::string_view(text).substr(0, text.size() - 1));
    o.utm_zone = number ? static_cast<int>(std::lround(std::clamp(*number, 0.0, 99.0))) : 0;
    o.utm_north = hemisphere == 'N';
    check_zone(*zone, text, o.utm_zone);
  }
  if (const auto origin = map.find("origin_deg_m")) o.origin = origin_from(*origin);
  o.above_mean_sea_level = map.choice("height", {"ellipsoidal", "msl"}, 0) == 1;
  if (const auto n = map.find("geoid_height_m")) {
    o.geoid_height = n->number();
    if (std::abs(*o.geoid_height) > 120.0) throw n->error(n->text(), "-110 to 90 m (geoid above ellipsoid)", "");
  }
  const bool local = o.frame == Frame::kNed || o.frame == Frame::kEnu;
  if (o.frame == Frame::kUtm && o.utm_zone == 0) throw map.error("frame: utm without a zone", "`utm_zone: 18N`", "");
  if (local && !o.origin)
    throw map.error("local coordinates without an origin", "`origin_deg_m: [lat, lon, h]`",
                    "A point in the region is enough for relative work: gravity and Earth rate are taken there.");
  return o;
}

PositionConverter::PositionConverter(const PositionOptions& options, std::string name, WeekClock::MakeError error)
    : name_(std::move(name)), error_(std::move(error)), options_(options) {
  using Frame = PositionOptions::Frame;
  if (options.frame == Frame::kNed || options.frame == Frame::kEnu) {
    if (!options.origin)
      throw InputError({name_, 0, "coordinates relative to an origin that is not stated", "",
                        "State `origin_deg_m: [lat, lon, h]` beside the file."});
    local_.emplace(*options.origin);
  }
}

record::Events PositionConverter::events() const {
  if (!options_.above_mean_sea_level || options_.geoid_height) return {};
  return {
      {record::Event::Severity::kWarning, "msl_height",
       fmt::format("{}: heights are above mean sea level and were used as they are; relative work is not affected, absolute "
                   "heights are off by the local geoid height (give `geoid_height_m`)",
                   name_),
       std::nullopt, 1}};
}

double PositionConverter::ellipsoidal(double height) const {
  return options_.above_mean_sea_level ? height + options_.geoid_height.value_or(0.0) : height;
}

Eigen::Vector3d PositionConverter::from_geodetic(double latitude_deg, double longitude_deg, double height) const {
  if (std::abs(latitude_deg) > 90.0) throw error_(fmt::format("latitude {} deg", latitude_deg), "-90 to 90", "");
  if (std::abs(longitude_deg) > 360.0) throw error_(fmt::format("longitude {} deg", longitude_deg), "-180 to 360", "");
  if (height < kLowest || height > kHighest) throw error_(fmt::format("height {} m", height), "a height in metres", "");
  return geo::ecef_from_geodetic(
      {latitude_deg * geo::kDegree, geo::wrap_angle(longitude_deg * geo::kDegree), ellipsoidal(height)});
}

Eigen::Vector3d PositionConverter::to_ecef(double a, double b, double c) const {
  using Frame = PositionOptions::Frame;
  switch (options_.frame) {
    case Frame::kGeodetic:
      return from_geodetic(a, b, c);
    case Frame::kEcef: {
      const double radius = std::hypot(a, b, c);
      if (radius < 6.3e6 || radius > 9.0e6)
        throw error_(fmt::format("a position {:.3f} km from the Earth's centre", radius * 1e-3), "6300 to 9000 km",
                     "Are these ECEF coordinates in metres?");
      return {a, b, c};
    }
    case Frame::kUtm: {
      if (a < 0.0 || a > 1.0e6 || b < -1.0e7 || b > 1.0e7)
        throw error_(fmt::format("UTM easting {}, northing {}", a, b), "0 to 1e6 and 0 to 1e7 m", "Are they swapped?");
      return geo::ecef_from_geodetic(geo::geodetic_from_utm(options_.utm_zone, options_.utm_north, a, b, ellipsoidal(c)));
    }
    case Frame::kNed:
    case Frame::kEnu:
      break;
  }
  const Eigen::Vector3d ned = options_.frame == Frame::kNed ? Eigen::Vector3d(a, b, c) : Eigen::Vector3d(b, a, -c);
  if (ned.norm() > kHighest)
    throw error_(fmt::format("{:.0f} m from the origin", ned.norm()), "local coordinates in metres", "");
  return local_->to_ecef(ned);
}

}  // namespace coast::io
