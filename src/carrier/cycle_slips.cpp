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

/// What was seen of each phase last.
class ArcNumbers {
 public:
  void go_through(DifferenceEpoch& epoch) {
    for (SatelliteDifference& satellite : epoch.satellites) {
      const std::vector<bool> broken = breaks(satellite, epoch.t);
      for (std::size_t i = 0; i < satellite.bands.size(); ++i)
        if (satellite.bands[i].phase) number(satellite.satellite, epoch.t, broken[i], satellite.bands[i]);
    }
  }

 private:
  /// Which phases are new, or have jumped against the first that is not.
  [[nodiscard]] std::vector<bool> breaks(const SatelliteDifference& satellite, geo::GpsTime t) const {
    std::vector<bool> broken(satellite.bands.size(), false);
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < satellite.bands.size(); ++i) {
      const BandDifference& band = satellite.bands[i];
      if (!band.phase) continue;
      const auto known = before_.find({satellite.satellite, band.band});
      broken[i] = known == before_.end() || known->second.given != band.arc;
      if (broken[i]) continue;
      if (!first) {
        first = i;
        continue;
      }
      const Before& then = known->second;
      const Before& other = before_.at({satellite.satellite, satellite.bands[*first].band});
      const double jump = (*band.phase - then.phase) - (*satellite.bands[*first].phase - other.phase);
      if (other.t != then.t || std::abs(jump) < largest_jump(t - then.t, satellite.base_elevation)) continue;
      broken[i] = broken[*first] = true;
    }
    return broken;
  }

  void number(record::Satellite satellite, geo::GpsTime t, bool is_new, BandDifference& band) {
    Before& now = before_[{satellite, band.band}];
    now = {t, *band.phase, band.arc, is_new ? ++last_ : now.arc};
    band.arc = now.arc;
  }

  std::map<Key, Before> before_;
  int last_ = 0;
};

}  // namespace

void break_arcs(std::vector<DifferenceEpoch>& epochs) {
  ArcNumbers numbers;
  for (DifferenceEpoch& epoch : epochs) numbers.go_through(epoch);
}

}  // namespace coast::carrier
