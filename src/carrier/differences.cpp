#include "coast/carrier/differences.hpp"

#include <algorithm>
#include <cmath>

#include "coast/carrier/signals.hpp"
#include "coast/carrier/solid_tides.hpp"
#include "cycle_slips.hpp"
#include "receiver_track.hpp"

namespace coast::carrier {

namespace {

using record::Satellite;

/// Base observations of one satellite minus the model at the base's position.
struct BaseSatellite {
  Satellite satellite;
  double elevation = 0.0;
  std::vector<TrackedBand> bands;  ///< code and phase minus the model
};

struct BaseEpoch {
  geo::GpsTime t;
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();
  std::vector<BaseSatellite> satellites;
};

/// Velocity of a moving base, from its positions half a second before and after.
std::optional<Eigen::Vector3d> velocity_of(const BasePosition& position, geo::GpsTime t) {
  constexpr double kHalf = 0.5;
  const std::optional<Eigen::Vector3d> before = position(t - kHalf), after = position(t + kHalf);
  if (!before || !after) return std::nullopt;
  return (*after - *before) / (2.0 * kHalf);
}

/// Solid tide of the base minus that of the rover: coordinates are of an Earth without tides. Over short baselines
/// it differs by a tenth of a millimetre per kilometre.
Eigen::Vector3d lifted(const Eigen::Vector3d& r_base_e, const std::optional<Eigen::Vector3d>& r_rover_e, geo::GpsTime t) {
  constexpr double kMatters = 10e3;  // m
  if (!r_rover_e || (r_base_e - *r_rover_e).norm() < kMatters) return Eigen::Vector3d::Zero();
  return solid_tide(r_base_e, t) - solid_tide(*r_rover_e, t);
}

/// @param r_rover_e  approximate
std::vector<BaseEpoch> residuals_of(const std::vector<TrackedEpoch>& base, const BasePosition& position,
                                    const std::optional<Eigen::Vector3d>& r_rover_e, const DifferenceOptions& options) {
  std::vector<BaseEpoch> epochs;
  for (const TrackedEpoch& tracked : base) {
    std::optional<Eigen::Vector3d> r_e = position(tracked.t);
    if (!r_e) continue;
    *r_e += lifted(*r_e, r_rover_e, tracked.t);
    BaseEpoch& epoch = epochs.emplace_back(BaseEpoch{tracked.t, *r_e, {}});
    const geo::Geodetic receiver = geo::geodetic_from_ecef(*r_e);
    const std::optional<Eigen::Vector3d> v_e = velocity_of(position, tracked.t);
    for (const TrackedSatellite& s : tracked.satellites) {
      const SignalPath path = path_to(s.state, *r_e, receiver, tracked.t, options.air.troposphere);
      if (path.direction.elevation < options.elevation_mask) continue;
      BaseSatellite& of = epoch.satellites.emplace_back(BaseSatellite{s.satellite, path.direction.elevation, s.bands});
      const double modelled = path.modelled(s.state);
      for (TrackedBand& band : of.bands) {
        double expected = modelled;
        if (options.base_antenna)
          expected += phase_centre_correction(*options.base_antenna, s.satellite.system, band.band, path.direction);
        if (band.code) *band.code -= expected;
        if (band.phase) *band.phase -= expected;
        if (band.rate && v_e)
          *band.rate -= modelled_rate(s.state, *r_e, *v_e);
        else
          band.rate.reset();
      }
    }
  }
  return epochs;
}

/// The base's residuals at any instant, linearly between its epochs.
class BaseInterpolation {
 public:
  BaseInterpolation(std::vector<BaseEpoch> epochs, double longest_gap) : epochs_(std::move(epochs)), gap_(longest_gap) {}

  /// Its epochs before and after an instant; the second with weight w, none if the first is at the same time.
  struct Pair {
    const BaseEpoch* first = nullptr;
    const BaseEpoch* second = nullptr;
    double w = 0.0;
    double age = 0.0;
  };
  Pair around(geo::GpsTime t) const {
    constexpr double kSame = 0.05;  // s: receivers' clock errors are milliseconds
    Pair pair;
    const auto after = std::ranges::lower_bound(epochs_, t - kSame, {}, &BaseEpoch::t);
    if (after == epochs_.end()) return pair;
    if (std::abs(after->t - t) <= kSame) {
      pair.first = &*after;
      pair.age = std::abs(after->t - t);
      return pair;
    }
    if (after == epochs_.begin() || after->t - std::prev(after)->t > gap_) return pair;
    pair.first = &*std::prev(after);
    pair.second = &*after;
    pair.w = (t - pair.first->t) / (pair.second->t - pair.first->t);
    pair.age = std::min(t - pair.first->t, pair.second->t - t);
    return pair;
  }

  static const BaseSatellite* find(const BaseEpoch& epoch, Satellite satellite) {
    const auto found = std::ranges::find(epoch.satellites, satellite, &BaseSatellite::satellite);
    return found == epoch.satellites.end() ? nullptr : &*found;
  }
  static const TrackedBand* find(const BaseSatellite& satellite, char band) {
    const auto found = std::ranges::find(satellite.bands, band, &TrackedBand::band);
    return found == satellite.bands.end() ? nullptr : &*found;
  }

  /// One satellite; without bands if it is missing.
  static BaseSatellite satellite_at(const Pair& pair, Satellite satellite) {
    const BaseSatellite* first = find(*pair.first, satellite);
    if (first == nullptr) return {};
    if (pair.second == nullptr) return *first;
    const BaseSatellite* second = find(*pair.second, satellite);
    if (second == nullptr) return {};
    BaseSatellite between = *first;
    between.elevation += pair.w * (second->elevation - first->elevation);
    std::erase_if(between.bands, [&](TrackedBand& band) {
      const TrackedBand* next = find(*second, band.band);
      if (next == nullptr) return true;
      interpolate(pair.w, next->code, band.code);
      interpolate(pair.w, next->rate, band.rate);
      if (band.phase && next->phase && band.arc == next->arc)
        *band.phase += pair.w * (*next->phase - *band.phase);
      else
        band.phase.reset();
      return !band.code && !band.phase;
    });
    return between;
  }

 private:
  static void interpolate(double w, const std::optional<double>& next, std::optional<double>& value) {
    if (value && next)
      *value += w * (*next - *value);
    else
      value.reset();
  }

  std::vector<BaseEpoch> epochs_;
  double gap_;
};

std::vector<BandDifference> bands_of(const TrackedSatellite& rover, const BaseSatellite& base) {
  constexpr int kManyArcs = 1 << 15;  // of one receiver: both numbers in one
  std::vector<BandDifference> bands;
  for (const TrackedBand& r : rover.bands) {
    const TrackedBand* b = BaseInterpolation::find(base, r.band);
    if (b == nullptr) continue;
    BandDifference d;
    d.band = r.band;
    d.frequency = r.frequency;
    if (r.code && b->code) d.code = *r.code - *b->code;
    if (r.phase && b->phase) d.phase = *r.phase - *b->phase;
    if (!d.code && !d.phase) continue;
    if (r.rate && b->rate) d.rate = *r.rate - *b->rate;
    d.rover_cn0 = r.cn0;
    d.base_cn0 = b->cn0;
    d.half_cycle = r.half_cycle || b->half_cycle;
    d.arc = r.arc % kManyArcs * kManyArcs + b->arc % kManyArcs;
    bands.push_back(d);
  }
  return bands;
}

/// The rover only.
std::vector<DifferenceEpoch> rover_alone(const std::vector<TrackedEpoch>& tracked, const std::optional<Eigen::Vector3d>& near_e,
                                         const DifferenceOptions& options) {
  std::vector<DifferenceEpoch> epochs;
  Eigen::Vector3d start_e = near_e.value_or(Eigen::Vector3d::Zero());
  for (const TrackedEpoch& at : tracked) {
    DifferenceEpoch& epoch = epochs.emplace_back();
    epoch.t = at.t;
    epoch.seen = static_cast<int>(at.codes.size());
    epoch.alone = single_point(at.codes, at.t, start_e, options.air, options.elevation_mask);
    if (epoch.alone) start_e = epoch.alone->r_e;
  }
  return epochs;
}

}  // namespace

double BandDifference::wavelength() const {
  return kSpeedOfLight / frequency;
}

std::vector<DifferenceEpoch> form_differences(const record::ObservationRecording& rover,
                                              const record::ObservationRecording& base, const SignalChoice& signals,
                                              const Orbits& orbits, const BasePosition& base_position,
                                              const DifferenceOptions& options) {
  const geo::GpsTime first = rover.epochs.front().t, last = rover.epochs.back().t;
  const double room = options.longest_base_gap_s + 1.0;
  Tracking of_rover{options.systems, {}, first, last, options.air.ionosphere_free},
      of_base{options.systems, {}, first - room, last + room};
  for (const auto& [band, pair] : signals) {
    of_rover.signals[band] = pair.rover;
    of_base.signals[band] = pair.base;
  }
  const std::vector<TrackedEpoch> tracked = track(rover, orbits, of_rover);
  std::vector<DifferenceEpoch> epochs = rover_alone(tracked, rover.approximate_r_e, options);
  const auto placed = std::ranges::find_if(epochs, [](const DifferenceEpoch& epoch) { return epoch.alone.has_value(); });
  const std::optional<Eigen::Vector3d> r_rover_e = placed == epochs.end() ? std::nullopt : std::optional(placed->alone->r_e);
  const BaseInterpolation bases(residuals_of(track(base, orbits, of_base), base_position, r_rover_e, options),
                                options.longest_base_gap_s);
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    DifferenceEpoch& epoch = epochs[i];
    const BaseInterpolation::Pair pair = bases.around(epoch.t);
    if (pair.first == nullptr) continue;
    epoch.age_s = pair.age;
    epoch.r_base_e = pair.first->r_e;
    if (pair.second != nullptr) epoch.r_base_e += pair.w * (pair.second->r_e - pair.first->r_e);
    for (const TrackedSatellite& s : tracked[i].satellites) {
      const BaseSatellite at_base = BaseInterpolation::satellite_at(pair, s.satellite);
      std::vector<BandDifference> bands = bands_of(s, at_base);
      if (!bands.empty()) epoch.satellites.push_back({s.satellite, s.state, at_base.elevation, std::move(bands)});
    }
  }
  break_arcs(epochs);
  return epochs;
}

}  // namespace coast::carrier
