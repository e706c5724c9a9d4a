#include "receiver_track.hpp"

#include <algorithm>

#include "coast/carrier/signals.hpp"

namespace coast::carrier {

namespace {

using record::Observation;
using record::Satellite;
using record::SatelliteSystem;

/// Numbers the arcs of one receiver's phases as its epochs come.
class ArcCounter {
 public:
  explicit ArcCounter(double longest_gap) : longest_gap_(longest_gap) {}

  int arc_of(const Observation& o, geo::GpsTime t) {
    Arc& arc = arcs_[{o.satellite, o.signal.band}];
    const bool broken = o.lost_lock || o.half_cycle != arc.half_cycle || t - arc.last > longest_gap_;
    if (broken) ++arc.number;
    arc.half_cycle = o.half_cycle;
    arc.last = t;
    return arc.number;
  }

 private:
  struct Arc {
    geo::GpsTime last;
    bool half_cycle = false;
    int number = 0;
  };
  double longest_gap_;
  std::map<std::pair<Satellite, char>, Arc> arcs_;
};

/// The code that single-point positions use: of the lowest band, the first there is.
const Observation* code_of(const std::vector<Observation>& observations, std::size_t begin, std::size_t end) {
  const Observation* first = nullptr;
  for (std::size_t i = begin; i < end; ++i)
    if (observations[i].code_m && (first == nullptr || observations[i].signal.band < first->signal.band))
      first = &observations[i];
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
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

double longest_gap(double interval) {
  constexpr double kAlways = 5.0;
  return std::max(kAlways, 1.5 * interval);
}

std::vector<TrackedEpoch> track(const record::ObservationRecording& receiver, const Orbits& orbits,
                                const std::map<std::pair<SatelliteSystem, char>, char>& signals, geo::GpsTime from,
                                geo::GpsTime to) {
  std::vector<TrackedEpoch> epochs;
  epochs.reserve(receiver.epochs.size());
  ArcCounter arcs(longest_gap(interval_of(receiver)));
  for (const record::ObservationEpoch& epoch : receiver.epochs) {
    if (epoch.t < from || epoch.t > to) continue;
    TrackedEpoch& tracked = epochs.emplace_back();
    tracked.t = epoch.t;
    const std::vector<Observation>& all = epoch.observations;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
      while (end < all.size() && all[end].satellite == all[begin].satellite) ++end;
      const Satellite satellite = all[begin].satellite;
      const Observation* code = code_of(all, begin, end);
      if (code == nullptr) continue;
      const std::optional<SatelliteState> state = at_transmission(orbits, satellite, epoch.t, *code->code_m);
      if (!state) continue;
      const int channel = channel_of(receiver, satellite);
      if (const auto f = carrier_frequency(satellite.system, code->signal.band, channel)) {
        const double factor = kL1Frequency / *f;
        tracked.codes.push_back({satellite, *state, *code->code_m, factor * factor, std::nullopt});
        if (code->doppler_hz) tracked.codes.back().range_rate = -*code->doppler_hz * kSpeedOfLight / *f;
      }
      TrackedSatellite of{satellite, *state, {}};
      for (std::size_t i = begin; i < end; ++i) {
        const auto wanted = signals.find({satellite.system, all[i].signal.band});
        if (wanted == signals.end() || wanted->second != all[i].signal.tracking) continue;
        const auto f = carrier_frequency(satellite.system, all[i].signal.band, channel);
        if (!f) continue;
        TrackedBand& band = of.bands.emplace_back();
        band.band = all[i].signal.band;
        band.frequency = *f;
        band.code = all[i].code_m;
        band.cn0 = all[i].cn0_dbhz.value_or(0.0);
        band.half_cycle = all[i].half_cycle;
        if (!all[i].phase_cycles) continue;
        band.phase = *all[i].phase_cycles * kSpeedOfLight / *f;
        band.arc = arcs.arc_of(all[i], epoch.t);
      }
      if (!of.bands.empty()) tracked.satellites.push_back(std::move(of));
    }
  }
  return epochs;
}

std::vector<std::optional<SinglePoint>> single_points(const record::ObservationRecording& receiver, const Orbits& orbits,
                                                      const AirModel& air, double elevation_mask) {
  std::vector<std::optional<SinglePoint>> points;
  Eigen::Vector3d start_e = receiver.approximate_r_e.value_or(Eigen::Vector3d::Zero());
  for (const TrackedEpoch& epoch : track(receiver, orbits, {}, receiver.epochs.front().t, receiver.epochs.back().t)) {
    points.push_back(single_point(epoch.codes, epoch.t, start_e, air, elevation_mask));
    if (points.back()) start_e = points.back()->r_e;
  }
  return points;
}

}  // namespace coast::carrier
