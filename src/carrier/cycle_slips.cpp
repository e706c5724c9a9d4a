#include "cycle_slips.hpp"

#include <cmath>

namespace coast::carrier {

namespace {

struct Before {
  geo::GpsTime t;
  double phase = 0.0;  ///< m
  int given = 0;       ///< the arc's number as it came
  int arc = 0;         ///< as it is numbered now
};

using Key = std::pair<record::Satellite, char>;

/// Jump of the difference of two phases beyond which one of them slipped, m. One cycle of any band is 19 cm or more; noise and
/// multipath come to 2 cm (four sigma) at the zenith, the ionosphere over a baseline changes by less than 0.3 mm/s.
double largest_jump(double step, double elevation) {
  constexpr double kNoise = 0.02, kIonosphere = 0.0003, kMost = 0.12;
  return std::min(kNoise / std::max(std::sin(elevation), 0.1) + kIonosphere * step, kMost);
}

}  // namespace

void break_arcs(std::vector<DifferenceEpoch>& epochs) {
  std::map<Key, Before> before;
  int last = 0;
  for (DifferenceEpoch& epoch : epochs)
    for (SatelliteDifference& satellite : epoch.satellites) {
      const BandDifference* first = nullptr;
      std::vector<bool> broken(satellite.bands.size(), false);
      for (std::size_t i = 0; i < satellite.bands.size(); ++i) {
        const BandDifference& band = satellite.bands[i];
        if (!band.phase) continue;
        const auto known = before.find({satellite.satellite, band.band});
        broken[i] = known == before.end() || known->second.given != band.arc;
        if (broken[i]) continue;
        if (first == nullptr) {
          first = &band;
          continue;
        }
        const Before& a = before.at({satellite.satellite, first->band});
        const double jump = (*band.phase - known->second.phase) - (*first->phase - a.phase);
        if (a.t != known->second.t || std::abs(jump) < largest_jump(epoch.t - a.t, satellite.base_elevation)) continue;
        broken[i] = true;
        broken[static_cast<std::size_t>(first - satellite.bands.data())] = true;
      }
      for (std::size_t i = 0; i < satellite.bands.size(); ++i) {
        BandDifference& band = satellite.bands[i];
        if (!band.phase) continue;
        Before& b = before[{satellite.satellite, band.band}];
        const int given = band.arc;
        if (broken[i]) b.arc = ++last;
        band.arc = b.arc;
        b.t = epoch.t;
        b.phase = *band.phase;
        b.given = given;
      }
    }
}

}  // namespace coast::carrier
