#include "receiver_track.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "coast/carrier/signals.hpp"
#include "quantile.hpp"

namespace coast::carrier {

namespace {

using record::Observation;
using record::Satellite;
using record::SatelliteSystem;

/// Numbers the arcs of one receiver's phases epoch by epoch.
class ArcCounter {
 public:
  explicit ArcCounter(double longest_gap) : longest_gap_(longest_gap) {}

  /// To be called for every observation of a band: a loss of lock also counts if the phase itself is missing.
  int arc_of(const Observation& o, geo::GpsTime t) {
    Arc& arc = arcs_[{o.satellite, o.signal.band}];
    arc.lost = arc.lost || o.lost_lock;
    if (!o.phase_cycles) return arc.number;
    if (arc.lost || o.half_cycle != arc.half_cycle || t - arc.last > longest_gap_) ++arc.number;
    arc.lost = false;
    arc.half_cycle = o.half_cycle;
    arc.last = t;
    return arc.number;
  }

 private:
  struct Arc {
    geo::GpsTime last;
    bool half_cycle = false;
    bool lost = false;
    int number = 0;
  };
  double longest_gap_;
  std::map<std::pair<Satellite, char>, Arc> arcs_;
};

/// The observations of one satellite at one epoch.
using OfSatellite = std::span<const Observation>;

/// The code used for single-point positions: the first of the lowest band.
const Observation* code_of(OfSatellite observations) {
  const Observation* first = nullptr;
  for (const Observation& o : observations)
    if (o.code_m && (first == nullptr || o.signal.band < first->signal.band)) first = &o;
  return first;
}

int channel_of(const record::ObservationRecording& receiver, Satellite satellite) {
  if (satellite.system != SatelliteSystem::kGlonass) return 0;
  const auto found = receiver.glonass_channels.find(satellite.number);
  return found == receiver.glonass_channels.end() ? 0 : found->second;
}

}  // namespace

double interval_of(const record::ObservationRecording& receiver) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < receiver.epochs.size(); ++i) steps.push_back(receiver.epochs[i].t - receiver.epochs[i - 1].t);
  if (steps.empty()) return 0.0;
  return median(std::move(steps));
}

double longest_gap(double interval) {
  constexpr double kAlways = 5.0;
  return std::max(kAlways, 1.5 * interval);
}

namespace {

std::vector<TrackedBand> bands_of(OfSatellite observations, geo::GpsTime t, int channel, const Tracking& wanted,
                                  ArcCounter& arcs) {
  std::vector<TrackedBand> bands;
  for (const Observation& o : observations) {
    const auto signal = wanted.signals.find({o.satellite.system, o.signal.band});
    const auto f = carrier_frequency(o.satellite.system, o.signal.band, channel);
    if (signal == wanted.signals.end() || signal->second != o.signal.tracking || !f) continue;
    TrackedBand& band = bands.emplace_back();
    band.band = o.signal.band;
    band.frequency = *f;
    band.code = o.code_m;
    if (o.phase_cycles) band.phase = *o.phase_cycles * kSpeedOfLight / *f;
    if (o.doppler_hz) band.rate = -*o.doppler_hz * kSpeedOfLight / *f;
    band.cn0 = o.cn0_dbhz.value_or(0.0);
    band.half_cycle = o.half_cycle;
    band.arc = arcs.arc_of(o, t);
  }
  return bands;
}

std::optional<CodeMeasurement> measurement_of(const Observation& code, const SatelliteState& state, int channel) {
  const auto f = carrier_frequency(code.satellite.system, code.signal.band, channel);
  if (!f) return std::nullopt;
  const double factor = kL1Frequency / *f;
  CodeMeasurement measurement{code.satellite, state, *code.code_m, factor * factor, std::nullopt};
  if (code.doppler_hz) measurement.range_rate = -*code.doppler_hz * kSpeedOfLight / *f;
  return measurement;
}

/// The combination of two codes in which delays proportional to 1/f^2 cancel; none if there is only one band.
std::optional<CodeMeasurement> without_ionosphere(CodeMeasurement first, OfSatellite observations, const Observation& code,
                                                  int channel) {
  for (const Observation& o : observations) {
    const auto f = carrier_frequency(o.satellite.system, o.signal.band, channel);
    if (!o.code_m || o.signal.band == code.signal.band || !f) continue;
    const double squared = kL1Frequency / *f * kL1Frequency / *f;
    const double a = squared / (squared - first.iono_factor), b = 1.0 - a;
    first.code = a * first.code + b * *o.code_m;
    first.iono_factor = 0.0;
    first.noise = std::hypot(a, b);
    return first;
  }
  return std::nullopt;
}

void track_satellite(const record::ObservationRecording& receiver, OfSatellite observations, const Orbits& orbits,
                     const Tracking& wanted, ArcCounter& arcs, TrackedEpoch& epoch) {
  const Satellite satellite = observations.front().satellite;
  const int channel = channel_of(receiver, satellite);
  std::vector<TrackedBand> bands = bands_of(observations, epoch.t, channel, wanted, arcs);
  const Observation* code = code_of(observations);
  if (code == nullptr) return;
  const std::optional<SatelliteState> state = at_transmission(orbits, satellite, epoch.t, *code->code_m);
  if (!state) return;
  std::optional<CodeMeasurement> measurement = measurement_of(*code, *state, channel);
  if (measurement && wanted.ionosphere_free) measurement = without_ionosphere(*measurement, observations, *code, channel);
  if (measurement) epoch.codes.push_back(*measurement);
  if (!bands.empty()) epoch.satellites.push_back({satellite, *state, std::move(bands)});
}

}  // namespace

std::vector<TrackedEpoch> track(const record::ObservationRecording& receiver, const Orbits& orbits, const Tracking& wanted) {
  std::vector<TrackedEpoch> epochs;
  ArcCounter arcs(longest_gap(interval_of(receiver)));
  for (const record::ObservationEpoch& epoch : receiver.epochs) {
    if (epoch.t < wanted.from || epoch.t > wanted.to) continue;
    TrackedEpoch& tracked = epochs.emplace_back();
    tracked.t = epoch.t;
    const OfSatellite all(epoch.observations);
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
      while (end < all.size() && all[end].satellite == all[begin].satellite) ++end;
      if (wanted.systems.contains(all[begin].satellite.system))
        track_satellite(receiver, all.subspan(begin, end - begin), orbits, wanted, arcs, tracked);
    }
  }
  return epochs;
}

std::vector<std::optional<SinglePoint>> single_points(const record::ObservationRecording& receiver, const Orbits& orbits,
                                                      const DifferenceOptions& options) {
  std::vector<std::optional<SinglePoint>> points;
  Eigen::Vector3d start_e = receiver.approximate_r_e.value_or(Eigen::Vector3d::Zero());
  const Tracking codes{options.systems, {}, receiver.epochs.front().t, receiver.epochs.back().t, options.air.ionosphere_free};
  for (const TrackedEpoch& epoch : track(receiver, orbits, codes)) {
    points.push_back(single_point(epoch.codes, epoch.t, start_e, options.air, options.elevation_mask));
    if (points.back()) start_e = points.back()->r_e;
  }
  return points;
}

}  // namespace coast::carrier
