#include "cycle_slips.hpp"

#include <algorithm>
#include <cmath>

#include "coast/carrier/signals.hpp"
#include "quantile.hpp"

namespace coast::carrier {

namespace {

using Key = std::pair<record::Satellite, char>;

/// Deviations of an epoch, minus their common part (clocks), relative to their bounds.
class Deviations {
 public:
  void add(const Key& key, double value, double bound) { all_.push_back({key, value, bound}); }

  /// Those beyond their bounds; if the whole epoch is worse than the bounds, those much larger than the median.
  [[nodiscard]] std::set<Key> beyond() const {
    constexpr std::size_t kEnough = 4;
    constexpr double kStandsOut = 4.0;  // times the median
    std::set<Key> slipped;
    if (all_.size() < kEnough) return slipped;
    std::vector<double> values, relative;
    for (const Deviation& d : all_) values.push_back(d.value);
    const double common = median(values);
    for (const Deviation& d : all_) relative.push_back(std::abs(d.value - common) / d.bound);
    const double bound = std::max(1.0, kStandsOut * median(relative));
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (relative[i] > bound) slipped.insert(all_[i].key);
    return slipped;
  }

 private:
  struct Deviation {
    Key key;
    double value, bound;
  };
  std::vector<Deviation> all_;
};

/// Last observation of each phase.
struct Before {
  geo::GpsTime t;
  double phase = 0.0;  ///< m
  std::optional<double> rate;
  int given = 0;  ///< original number of the arc
  int arc = 0;    ///< new number
};
using Phases = std::map<Key, Before>;

/// Jump of the difference of two phases above which one of them slipped, m. One cycle of any band is 19 cm or more; noise and
/// multipath are 2 cm (four sigma) at the zenith, the ionosphere over a baseline changes by less than 0.3 mm/s.
double largest_jump(double step, double elevation) {
  constexpr double kNoise = 0.02, kIonosphere = 0.0003, kMost = 0.12;
  return std::min(kNoise / std::max(std::sin(elevation), 0.1) + kIonosphere * step, kMost);
}

/// Compares the first phase of each satellite that is not new with the others.
std::set<Key> geometry_free(const DifferenceEpoch& epoch, const Phases& before) {
  std::set<Key> slipped;
  for (const SatelliteDifference& satellite : epoch.satellites) {
    const BandDifference* first = nullptr;
    for (const BandDifference& band : satellite.bands) {
      const auto known = before.find({satellite.satellite, band.band});
      if (!band.phase || known == before.end() || known->second.given != band.arc) continue;
      if (first == nullptr) {
        first = &band;
        continue;
      }
      const Before& then = known->second;
      const Before& other = before.at({satellite.satellite, first->band});
      const double jump = (*band.phase - then.phase) - (*first->phase - other.phase);
      if (other.t != then.t || std::abs(jump) < largest_jump(epoch.t - then.t, satellite.base_elevation)) continue;
      slipped.insert({satellite.satellite, first->band});
      slipped.insert({satellite.satellite, band.band});
    }
  }
  return slipped;
}

std::set<Key> by_doppler(const DifferenceEpoch& epoch, const Phases& before) {
  constexpr double kLongest = 2.0;  // s
  constexpr double kNoise = 0.15;   // m/s at the zenith: four sigma of two receivers
  constexpr double kJerk = 0.5;     // m/s^3 / 12: for the difference between the mean of both ends and the mean rate
  Deviations deviations;
  for (const SatelliteDifference& satellite : epoch.satellites)
    for (const BandDifference& band : satellite.bands) {
      const Key key{satellite.satellite, band.band};
      const auto then = before.find(key);
      if (!band.phase || !band.rate || then == before.end() || !then->second.rate || then->second.given != band.arc) continue;
      const double dt = epoch.t - then->second.t;
      if (dt > kLongest) continue;
      const double expected = 0.5 * dt * (*band.rate + *then->second.rate);
      const double bound = kNoise * dt / std::max(std::sin(satellite.base_elevation), 0.1) + kJerk * dt * dt * dt;
      deviations.add(key, *band.phase - then->second.phase - expected, bound);
    }
  return deviations.beyond();
}

/// Wide-lane cycles of the first two bands with code and phase: difference of their ambiguities, noise and multipath of codes.
struct WideLane {
  Key first, second;
  int first_arc = 0, second_arc = 0;
  double cycles = 0.0;
};

std::optional<WideLane> wide_lane(const SatelliteDifference& satellite) {
  std::vector<const BandDifference*> bands;
  for (const BandDifference& band : satellite.bands)
    if (band.code && band.phase) bands.push_back(&band);
  if (bands.size() < 2) return std::nullopt;
  const BandDifference &a = *bands[0], &b = *bands[1];
  const double phases = (a.frequency * *a.phase - b.frequency * *b.phase) / (a.frequency - b.frequency);
  const double codes = (a.frequency * *a.code + b.frequency * *b.code) / (a.frequency + b.frequency);
  const double cycles = (phases - codes) * (a.frequency - b.frequency) / kSpeedOfLight;
  return WideLane{{satellite.satellite, a.band}, {satellite.satellite, b.band}, a.arc, b.arc, cycles};
}

/// Means of wide lanes along the arcs.
class MelbourneWuebbena {
 public:
  /// @param next  the following epoch, which must confirm; null: none
  std::set<Key> slips(const DifferenceEpoch& epoch, const DifferenceEpoch* next) {
    constexpr double kConfirmed = 1.0;  // cycle, between two epochs after a slip
    const Deviations now = deviations(epoch), then = next == nullptr ? Deviations{} : deviations(*next);
    const std::set<Key> left = now.beyond(), confirmed = then.beyond();
    std::set<Key> slipped;
    for (const SatelliteDifference& satellite : epoch.satellites) {
      const std::optional<WideLane> lane = wide_lane(satellite);
      if (!lane) continue;
      const bool both = left.contains(lane->first) && confirmed.contains(lane->first);
      if (both && std::abs(cycles_in(*next, satellite.satellite) - lane->cycles) < kConfirmed) {
        slipped.insert(lane->first);
        slipped.insert(lane->second);
        means_.erase(lane->first);
      }
      if (!left.contains(lane->first)) take(*lane);
    }
    return slipped;
  }

 private:
  struct Mean {
    int first_arc = 0, second_arc = 0;
    double mean = 0.0, squares = 0.0;
    int count = 0;
  };

  /// From the converged means.
  [[nodiscard]] Deviations deviations(const DifferenceEpoch& epoch) const {
    constexpr int kSettled = 10;
    constexpr double kSigmas = 4.0;
    constexpr double kLeast = 1.5;  // cycles
    Deviations all;
    for (const SatelliteDifference& satellite : epoch.satellites) {
      const std::optional<WideLane> lane = wide_lane(satellite);
      if (!lane) continue;
      const auto of = means_.find(lane->first);
      if (of == means_.end() || !same(of->second, *lane) || of->second.count < kSettled) continue;
      const double sd = std::sqrt(of->second.squares / (of->second.count - 1));
      all.add(lane->first, lane->cycles - of->second.mean, std::max(kLeast, kSigmas * sd));
    }
    return all;
  }
  static double cycles_in(const DifferenceEpoch& epoch, record::Satellite satellite) {
    const auto found = std::ranges::find(epoch.satellites, satellite, &SatelliteDifference::satellite);
    return wide_lane(*found)->cycles;
  }
  static bool same(const Mean& mean, const WideLane& lane) {
    return mean.first_arc == lane.first_arc && mean.second_arc == lane.second_arc;
  }
  void take(const WideLane& lane) {
    Mean& m = means_[lane.first];
    if (!same(m, lane)) m = {lane.first_arc, lane.second_arc, 0.0, 0.0, 0};
    ++m.count;
    const double off = lane.cycles - m.mean;
    m.mean += off / m.count;
    m.squares += off * (lane.cycles - m.mean);
  }

  std::map<Key, Mean> means_;
};

/// Gives new numbers to new arcs and after slips.
class ArcNumbers {
 public:
  void number(DifferenceEpoch& epoch, const std::set<Key>& slipped) {
    for (SatelliteDifference& satellite : epoch.satellites)
      for (BandDifference& band : satellite.bands) {
        if (!band.phase) continue;
        const Key key{satellite.satellite, band.band};
        const auto known = before_.find(key);
        const bool is_new = known == before_.end() || known->second.given != band.arc || slipped.contains(key);
        const int arc = is_new ? ++last_ : known->second.arc;
        before_[key] = {epoch.t, *band.phase, band.rate, band.arc, arc};
        band.arc = arc;
      }
  }
  [[nodiscard]] const Phases& before() const { return before_; }

 private:
  Phases before_;
  int last_ = 0;
};

}  // namespace

void break_arcs(std::vector<DifferenceEpoch>& epochs) {
  ArcNumbers numbers;
  MelbourneWuebbena wide_lanes;
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    std::set<Key> slipped = geometry_free(epochs[i], numbers.before());
    slipped.merge(by_doppler(epochs[i], numbers.before()));
    slipped.merge(wide_lanes.slips(epochs[i], i + 1 < epochs.size() ? &epochs[i + 1] : nullptr));
    numbers.number(epochs[i], slipped);
  }
}

}  // namespace coast::carrier
