#include "ephemerides.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

/// Of neighbours with the same key the first is kept.  @return number of removed ones
template <class Ephemeris, class Key>
long drop_repeated(std::vector<Ephemeris>& all, const Key& key) {
  const auto end = std::unique(all.begin(), all.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); });
  const auto count = static_cast<long>(all.end() - end);
  all.erase(end, all.end());
  return count;
}

}  // namespace

bool is_possible(const record::KeplerEphemeris& e) {
  constexpr double kLeastRoot = 2500.0;  // sqrt(m): below the surface
  constexpr double kMostRoot = 8000.0;   // 64 000 km
  const std::array rest = {
      e.clock[1], e.clock[2], e.mean_anomaly, e.delta_n, e.perigee, e.node, e.node_rate,  e.inclination,    e.inclination_rate,
      e.cuc,      e.cus,      e.crc,          e.crs,     e.cic,     e.cis,  e.accuracy_m, e.group_delay[0], e.group_delay[1]};
  if (!std::ranges::all_of(rest, [](double value) { return std::isfinite(value); })) return false;
  return e.eccentricity >= 0.0 && e.eccentricity < 0.5 && e.sqrt_a > kLeastRoot && e.sqrt_a < kMostRoot &&
         std::abs(e.clock[0]) < 1.0;
}

bool is_possible(const record::TabulatedEphemeris& e) {
  constexpr double kNearest = 7e6;   // m
  constexpr double kFarthest = 6e7;  // m
  constexpr double kFastest = 1e4;   // m/s
  return e.r_e.norm() > kNearest && e.r_e.norm() < kFarthest && e.v_e.norm() < kFastest && e.a_e.norm() < 1.0 &&
         std::abs(e.clock_bias) < 1.0 && std::isfinite(e.clock_drift);
}

geo::GpsTime nearest_second_of_week(geo::GpsTime to, double sow) {
  constexpr double kWeek = 604800.0;
  return to + std::remainder(sow - to.sow(), kWeek);
}

double accuracy_of_ura(int index) {
  constexpr int kTurn = 6;
  // The values that the standard rounds: 2.8, 5.7, 11.3.
  if (index <= kTurn) return std::round(10.0 * std::exp2(1.0 + 0.5 * index)) / 10.0;
  return std::exp2(index - 2.0);
}

/// OS SIS ICD 2.1, table 89.
double accuracy_of_sisa(int index) {
  if (index < 50) return 0.01 * index;
  if (index < 75) return 0.5 + 0.02 * (index - 50);
  if (index < 100) return 1.0 + 0.04 * (index - 75);
  return index <= 125 ? 2.0 + 0.16 * (index - 100) : 0.0;
}

geo::GpsTime nearest_second_of_moscow_day(geo::GpsTime to, double second_of_day) {
  constexpr double kDay = 86400.0, kMoscow = 3.0 * geo::kHour;
  return to + std::remainder(second_of_day - kMoscow + geo::leap_seconds(to) - to.sow(), kDay);
}

bool is_stated_week(geo::GpsTime t, int stated, int first, int weeks) {
  const auto is = [&](geo::GpsTime instant) { return instant.week() >= first && (instant.week() - first) % weeks == stated; };
  return is(t - geo::kHour) || is(t + geo::kHour);
}

bool is_beidou_geostationary(record::Satellite satellite) {
  constexpr int kLastOfFirst = 5, kFirstOfNew = 59;
  return satellite.system == record::SatelliteSystem::kBeidou &&
         (satellite.number <= kLastOfFirst || satellite.number >= kFirstOfNew);
}

long sort_out(record::NavigationRecording& recording) {
  const auto kepler_key = [](const record::KeplerEphemeris& e) {
    return std::tuple(e.satellite, e.toe, e.sources, e.issue, e.toc);
  };
  std::ranges::stable_sort(recording.kepler, {}, kepler_key);
  const auto tabulated_key = [](const record::TabulatedEphemeris& e) { return std::tuple(e.satellite, e.t); };
  std::ranges::stable_sort(recording.tabulated, {}, tabulated_key);
  return drop_repeated(recording.kepler, kepler_key) + drop_repeated(recording.tabulated, tabulated_key);
}

}  // namespace coast::io
