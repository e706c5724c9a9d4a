#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/carrier/orbits.hpp"

namespace coast::carrier {

namespace {

using record::KeplerEphemeris;
using record::Satellite;
using record::SatelliteSystem;
using record::TabulatedEphemeris;

/// Time from its reference up to which an ephemeris is used, s.
double validity(SatelliteSystem system) {
  constexpr double kHour = 3600.0;
  switch (system) {
    case SatelliteSystem::kGalileo:
      return 4.0 * kHour;
    case SatelliteSystem::kBeidou:
      return kHour + 60.0;  // transmitted hourly
    case SatelliteSystem::kGlonass:
      return 0.25 * kHour + 60.0;
    case SatelliteSystem::kSbas:
      return 360.0;
    default:
      return 2.0 * kHour;
  }
}

geo::GpsTime time_of(const KeplerEphemeris& e) {
  return e.toe;
}
geo::GpsTime time_of(const TabulatedEphemeris& e) {
  return e.t;
}

/// Effective distance of an ephemeris from its reference, s. That of GPS is fitted to both sides; those of Galileo and BeiDou
/// are predictions, and before their reference soon wrong by tens of metres: an hour there counts as four.
double age(SatelliteSystem system, double since_reference) {
  constexpr double kBackward = 4.0;
  const bool foretells = system == SatelliteSystem::kGalileo || system == SatelliteSystem::kBeidou;
  return foretells && since_reference < 0.0 ? -kBackward * since_reference : std::abs(since_reference);
}

/// I/NAV has the group delay of E5b and E1 and is used by most receivers: bits 0 and 2 of the sources.
bool is_inav(const KeplerEphemeris& e) {
  return (e.sources & 5) != 0;
}

/// The closest in time; among equals the preferred one.
template <class Ephemeris, class Preferred>
const Ephemeris* nearest_valid(const std::map<Satellite, std::vector<Ephemeris>>& all, Satellite satellite, geo::GpsTime t,
                               const Preferred& preferred) {
  const auto found = all.find(satellite);
  if (found == all.end()) return nullptr;
  const Ephemeris* best = nullptr;
  double least = 0.0;
  for (const Ephemeris& e : found->second) {
    const double off = age(satellite.system, t - time_of(e));
    if (off > validity(satellite.system)) continue;
    if (best == nullptr || off < least || (off == least && preferred(e) && !preferred(*best))) {
      best = &e;
      least = off;
    }
  }
  return best;
}

}  // namespace

BroadcastOrbits::BroadcastOrbits(const record::NavigationRecording& navigation) {
  for (const KeplerEphemeris& e : navigation.kepler) kepler_[e.satellite].push_back(e);
  for (const TabulatedEphemeris& e : navigation.tabulated)
    if (e.health == 0) tabulated_[e.satellite].push_back(e);
  for (auto& [satellite, ephemerides] : kepler_) {
    leave_out_strangers(satellite, ephemerides);  // an unhealthy neighbour is useful for this check
    std::erase_if(ephemerides, [](const KeplerEphemeris& e) { return e.health != 0; });
  }
}

void BroadcastOrbits::leave_out_strangers(Satellite satellite, std::vector<KeplerEphemeris>& ephemerides) {
  constexpr double kFar = 1e5;           // m: beyond the error of any old ephemeris
  constexpr double kTogether = 43200.0;  // s: half a day; further apart they cannot be compared
  const auto apart = [&](const KeplerEphemeris& a, const KeplerEphemeris& b) {
    const geo::GpsTime middle = a.toe + 0.5 * (b.toe - a.toe);
    return (satellite_state(a, middle).r_e - satellite_state(b, middle).r_e).norm() > kFar;
  };
  for (std::size_t i = 1; i + 1 < ephemerides.size();) {
    const KeplerEphemeris& before = ephemerides[i - 1];
    const KeplerEphemeris& after = ephemerides[i + 1];
    const KeplerEphemeris& e = ephemerides[i];
    if (after.toe - before.toe > kTogether || apart(before, after) || !apart(before, e) || !apart(e, after)) {
      ++i;
      continue;
    }
    events_.push_back({record::Event::Severity::kWarning, "ephemeris_left_out",
                       fmt::format("the ephemeris of {} at {} puts it elsewhere than those before and after: left out",
                                   to_string(satellite), geo::to_string(e.toe)),
                       e.toe, 1});
    ephemerides.erase(ephemerides.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

const KeplerEphemeris* BroadcastOrbits::kepler_at(Satellite satellite, geo::GpsTime t) const {
  return nearest_valid(kepler_, satellite, t, is_inav);
}

const TabulatedEphemeris* BroadcastOrbits::tabulated_at(Satellite satellite, geo::GpsTime t) const {
  return nearest_valid(tabulated_, satellite, t, [](const TabulatedEphemeris&) { return false; });
}

std::optional<SatelliteState> BroadcastOrbits::at(Satellite satellite, geo::GpsTime t) const {
  if (const KeplerEphemeris* e = kepler_at(satellite, t)) return satellite_state(*e, t);
  if (const TabulatedEphemeris* e = tabulated_at(satellite, t)) return satellite_state(*e, t);
  return std::nullopt;
}

}  // namespace coast::carrier
