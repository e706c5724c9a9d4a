#include "coast/carrier/differences.hpp"

#include <algorithm>

#include "base_residuals.hpp"
#include "coast/carrier/signals.hpp"
#include "cycle_slips.hpp"

namespace coast::carrier {

namespace {

std::vector<BandDifference> bands_of(const TrackedSatellite& rover, const BaseSatellite& base) {
  constexpr int kManyArcs = 1 << 15;  // of one receiver: both numbers in one
  std::vector<BandDifference> bands;
  for (const TrackedBand& r : rover.bands) {
    const auto b = std::ranges::find(base.bands, r.band, &TrackedBand::band);
    if (b == base.bands.end()) continue;
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
