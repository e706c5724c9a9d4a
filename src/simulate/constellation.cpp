#include "constellation.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coast/carrier/orbits.hpp"
#include "coast/geo/units.hpp"
#include "coast/simulate/random.hpp"

namespace coast::simulate {

namespace {

using record::KeplerEphemeris;
using record::SatelliteSystem;
constexpr double kPi = std::numbers::pi;

/// Walker pattern of one system.
struct Pattern {
  int planes = 0;
  int in_plane = 0;
  double a = 0.0;            ///< m
  double inclination = 0.0;  ///< rad
  double step = 0.0;         ///< s between ephemerides
  double phasing = 0.0;      ///< of a plane relative to the previous one, as a fraction of the spacing in it
  double node = 0.0;         ///< rad, of the first plane
};

Pattern pattern_of(SatelliteSystem system) {
  constexpr double kHour = 3600.0;
  switch (system) {
    case SatelliteSystem::kGps:
      return {6, 5, 26559.7e3, 55.0 * geo::kDegree, 2.0 * kHour, 0.4, 0.3};
    case SatelliteSystem::kGalileo:
      return {3, 8, 29600.3e3, 56.0 * geo::kDegree, 0.5 * kHour, 0.33, 0.9};
    case SatelliteSystem::kBeidou:
      return {3, 8, 27906.1e3, 55.0 * geo::kDegree, kHour, 0.6, 1.5};
    case SatelliteSystem::kGlonass:
      return {3, 8, 25508.2e3, 64.8 * geo::kDegree, 0.5 * kHour, 0.5, 0.1};
    default:
      throw std::invalid_argument("constellation: only GPS, Galileo, BeiDou and GLONASS are simulated");
  }
}

double mean_motion(SatelliteSystem system, double a) {
  const double mu = system == SatelliteSystem::kGps ? 3.986005e14 : 3.986004418e14;
  return std::sqrt(mu / (a * a * a));
}

/// The first ephemeris: BeiDou's numbers begin after the geostationary ones.
KeplerEphemeris first_of(SatelliteSystem system, const Pattern& p, int plane, int slot, geo::GpsTime toe, Normal& draw) {
  constexpr int kBeidouMedium = 19;
  KeplerEphemeris e;
  const int number = plane * p.in_plane + slot + (system == SatelliteSystem::kBeidou ? kBeidouMedium : 1);
  e.satellite = {system, static_cast<std::uint8_t>(number)};
  e.toe = e.toc = toe;
  e.clock = {1e-4 * draw(), 3e-12 * draw(), 0.0};
  e.sqrt_a = std::sqrt(p.a);
  e.eccentricity = 0.003 + 0.002 * std::abs(draw());
  const double spacing = 2.0 * kPi / p.in_plane;
  e.mean_anomaly = spacing * (slot + p.phasing * plane) + 0.03 * draw();
  e.perigee = 1.0 + 0.3 * draw();
  e.node = p.node + 2.0 * kPi * plane / p.planes;
  e.node_rate = -8e-9;
  e.inclination = p.inclination + 0.005 * draw();
  e.accuracy_m = 2.0;
  e.sources = system == SatelliteSystem::kGalileo ? 517 : 0;  // I/NAV, clock of E1 and E5b
  e.issue = 1;
  return e;
}

/// The same orbit and clock, with a later reference time.
KeplerEphemeris later(const KeplerEphemeris& first, double seconds) {
  KeplerEphemeris e = first;
  e.toe = e.toc = first.toe + seconds;
  e.clock[0] += seconds * e.clock[1];
  e.mean_anomaly =
      std::remainder(first.mean_anomaly + mean_motion(e.satellite.system, e.sqrt_a * e.sqrt_a) * seconds, 2.0 * kPi);
  // The node refers to the beginning of the week; when a new one begins, the Earth has rotated further.
  const double begin = (e.toe.week() - first.toe.week()) * 604800.0;
  e.node = std::remainder(first.node + first.node_rate * seconds - 7.2921151467e-5 * begin, 2.0 * kPi);
  e.issue = first.issue + static_cast<int>(std::lround(seconds / 900.0));
  return e;
}

record::TabulatedEphemeris tabulated(const KeplerEphemeris& kepler, geo::GpsTime t) {
  constexpr int kChannels = 14;
  const carrier::SatelliteState state = carrier::satellite_state(kepler, t);
  record::TabulatedEphemeris e;
  e.satellite = kepler.satellite;
  e.t = t;
  e.clock_bias = state.clock_s;
  e.r_e = state.r_e;
  e.v_e = state.v_e;
  e.channel = kepler.satellite.number % kChannels - 7;
  return e;
}

}  // namespace

record::NavigationRecording constellation(const std::vector<SatelliteSystem>& systems, geo::GpsTime from, geo::GpsTime to,
                                          std::uint64_t seed) {
  record::NavigationRecording navigation;
  navigation.source = "simulated";
  for (const SatelliteSystem system : systems) {
    Normal draw(stream_seed(seed, {40, static_cast<std::uint64_t>(system)}));
    const Pattern p = pattern_of(system);
    const double begin = std::floor(from.sow() / p.step) * p.step;
    const geo::GpsTime toe = from + (begin - from.sow());
    for (int plane = 0; plane < p.planes; ++plane)
      for (int slot = 0; slot < p.in_plane; ++slot) {
        const KeplerEphemeris first = first_of(system, p, plane, slot, toe, draw);
        for (double after = 0.0; toe + after <= to + p.step; after += p.step) {
          const KeplerEphemeris e = later(first, after);
          if (system == SatelliteSystem::kGlonass)
            navigation.tabulated.push_back(tabulated(e, toe + after));
          else
            navigation.kepler.push_back(e);
        }
      }
  }
  return navigation;
}

}  // namespace coast::simulate
