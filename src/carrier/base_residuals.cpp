#include "base_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "coast/carrier/signals.hpp"
#include "coast/carrier/solid_tides.hpp"
#include "quantile.hpp"

namespace coast::carrier {

namespace {

using record::Satellite;
using record::SatelliteSystem;

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

bool stands(const std::vector<BaseEpoch>& epochs) {
  constexpr double kTides = 0.5;  // m
  return !epochs.empty() &&
         std::ranges::all_of(epochs, [&](const BaseEpoch& e) { return (e.r_e - epochs.front().r_e).norm() < kTides; });
}

/// Continues the arcs of phases that were only missing. The change of all phases of a system and band in common is the clock's;
/// a satellite's own, of its clock and the air, goes on as before within centimetres, and a slip is at least a cycle.
class Bridges {
 public:
  void across(BaseEpoch& epoch) {
    const std::map<Group, double> clocks = clock_changes(epoch);
    for (BaseSatellite& s : epoch.satellites)
      for (TrackedBand& band : s.bands) {
        if (!band.phase) continue;
        Last next{epoch.t, *band.phase, 0.0, band.arc, 0};
        const auto last = last_.find({s.satellite, band.band});
        next.number =
            last == last_.end() ? ++newest_ : continued(last->second, group_of(s, band, last->second), clocks, band, next);
        band.arc = next.number;
        last_[{s.satellite, band.band}] = next;
      }
  }

 private:
  struct Last {
    geo::GpsTime t;
    double phase = 0.0;  ///< m
    double rate = 0.0;   ///< of the satellite's own, m/s
    int given = 0, number = 0;
    int rates = 0;  ///< in the mean
    [[nodiscard]] double predicted(geo::GpsTime to) const { return phase + rate * (to - t); }
  };
  /// Phases that share a clock and were last seen at the same time.
  using Group = std::tuple<SatelliteSystem, char, geo::GpsTime>;
  static Group group_of(const BaseSatellite& s, const TrackedBand& band, const Last& last) {
    return {s.satellite.system, band.band, last.t};
  }

  [[nodiscard]] std::map<Group, double> clock_changes(const BaseEpoch& epoch) const {
    constexpr std::size_t kEnough = 4;  // so that the median is the clock's change
    std::map<Group, std::vector<double>> changes;
    for (const BaseSatellite& s : epoch.satellites)
      for (const TrackedBand& band : s.bands)
        if (const auto last = last_.find({s.satellite, band.band}); band.phase && last != last_.end())
          changes[group_of(s, band, last->second)].push_back(*band.phase - last->second.predicted(epoch.t));
    std::map<Group, double> clocks;
    for (const auto& [group, values] : changes)
      if (values.size() >= kEnough) clocks[group] = median(values);
    return clocks;
  }
  /// @return the number of the arc; sets the rate of `next`
  int continued(const Last& last, const Group& group, const std::map<Group, double>& clocks, const TrackedBand& band,
                Last& next) {
    constexpr double kSame = 0.3;      // cycles
    constexpr double kSettles = 60.0;  // s: of the mean rate, longer than multipath lasts
    const auto clock = clocks.find(group);
    const double dt = next.t - last.t;
    if (clock == clocks.end() || !(dt > 0.0)) return band.arc == last.given ? last.number : ++newest_;
    const double surprise = next.phase - last.predicted(next.t) - clock->second;
    const bool same = band.arc == last.given;
    if (!same && std::abs(surprise) > kSame * kSpeedOfLight / band.frequency) return ++newest_;
    next.rates = last.rates + 1;
    const double weight = same ? std::clamp(dt / kSettles, 1.0 / next.rates, 1.0) : 0.0;
    next.rate = last.rate + weight * surprise / dt;
    return last.number;
  }

  std::map<std::pair<Satellite, char>, Last> last_;
  int newest_ = 0;
};

void bridge_gaps(std::vector<BaseEpoch>& epochs) {
  if (!stands(epochs)) return;
  Bridges bridges;
  for (BaseEpoch& epoch : epochs) bridges.across(epoch);
}

const BaseSatellite* find(const BaseEpoch& epoch, Satellite satellite) {
  const auto found = std::ranges::find(epoch.satellites, satellite, &BaseSatellite::satellite);
  return found == epoch.satellites.end() ? nullptr : &*found;
}

void interpolate(double w, const std::optional<double>& next, std::optional<double>& value) {
  if (value && next)
    *value += w * (*next - *value);
  else
    value.reset();
}

}  // namespace

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
  bridge_gaps(epochs);
  return epochs;
}

BaseInterpolation::BaseInterpolation(std::vector<BaseEpoch> epochs, double longest_gap)
    : epochs_(std::move(epochs)), gap_(longest_gap), stands_(stands(epochs_)) {}

BaseInterpolation::Pair BaseInterpolation::around(geo::GpsTime t) const {
  constexpr double kSame = 0.05;    // s: receivers' clock errors are milliseconds
  constexpr double kBeyond = 60.0;  // s: until then a satellite's clock goes wrong by a centimetre or two
  Pair pair;
  const auto after = std::ranges::lower_bound(epochs_, t - kSame, {}, &BaseEpoch::t);
  const bool inside = after != epochs_.end() && after != epochs_.begin();
  const BaseEpoch* end = epochs_.empty() ? nullptr : after == epochs_.end() ? &epochs_.back() : &*after;
  if (end == nullptr) return pair;
  if (std::abs(end->t - t) <= kSame || (!inside && stands_ && std::abs(end->t - t) <= std::min(kBeyond, gap_))) {
    pair.first = end;
    pair.age = std::abs(end->t - t);
    return pair;
  }
  if (!inside || after->t - std::prev(after)->t > gap_) return pair;
  pair.first = &*std::prev(after);
  pair.second = &*after;
  pair.w = (t - pair.first->t) / (pair.second->t - pair.first->t);
  pair.age = std::min(t - pair.first->t, pair.second->t - t);
  return pair;
}

BaseSatellite BaseInterpolation::satellite_at(const Pair& pair, Satellite satellite) {
  const BaseSatellite* first = find(*pair.first, satellite);
  if (first == nullptr) return {};
  if (pair.second == nullptr) return *first;
  const BaseSatellite* second = find(*pair.second, satellite);
  if (second == nullptr) return {};
  BaseSatellite between = *first;
  between.elevation += pair.w * (second->elevation - first->elevation);
  std::erase_if(between.bands, [&](TrackedBand& band) {
    const auto next = std::ranges::find(second->bands, band.band, &TrackedBand::band);
    if (next == second->bands.end()) return true;
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

}  // namespace coast::carrier
