#include "coast/simulate/observations.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "coast/carrier/atmosphere.hpp"
#include "coast/carrier/orbits.hpp"
#include "coast/carrier/signals.hpp"
#include "coast/carrier/solid_tides.hpp"
#include "coast/carrier/surface_weather.hpp"
#include "coast/carrier/wind_up.hpp"
#include "coast/geo/units.hpp"
#include "coast/simulate/random.hpp"
#include "constellation.hpp"

namespace coast::simulate {

namespace {

using carrier::kSpeedOfLight;
using record::Satellite;
using record::SatelliteSystem;

std::vector<record::Signal> signals_of(SatelliteSystem system) {
  switch (system) {
    case SatelliteSystem::kGps:
      return {{'1', 'C'}, {'2', 'W'}, {'5', 'Q'}};
    case SatelliteSystem::kGalileo:
      return {{'1', 'C'}, {'5', 'Q'}, {'7', 'Q'}};
    case SatelliteSystem::kBeidou:
      return {{'2', 'I'}, {'6', 'I'}, {'7', 'I'}};
    default:
      return {{'1', 'C'}, {'2', 'C'}};
  }
}

/// Stationary Gauss-Markov process of unit variance, simulated at any times in order.
class GaussMarkov {
 public:
  GaussMarkov(std::uint64_t seed, double time) : draw_(seed), time_(time), value_(draw_()) {}
  double at(double t) {
    const double phi = std::exp(-(t - t_) / time_);
    value_ = phi * value_ + std::sqrt(1.0 - phi * phi) * draw_();
    t_ = t;
    return value_;
  }

 private:
  Normal draw_;
  double time_;
  double t_ = 0.0;
  double value_;
};

/// A receiver's state for one phase.
struct PhaseLock {
  double cycles = 0.0;  ///< the ambiguity
  double last = -1e9;   ///< s, when it was last tracked
};

/// One receiver, epoch by epoch.
class Receiver {
 public:
  struct Clock {
    double offset = 0.0, drift = 0.0;  ///< s, s/s
    [[nodiscard]] double at(double t) const {
      constexpr double kMillisecond = 1e-3;
      return std::remainder(offset + drift * t, kMillisecond);
    }
  };

  Receiver(const ObservationOptions& options, const carrier::BroadcastOrbits& orbits, const Eigen::Vector3d& r_base_e,
           geo::GpsTime start, std::uint64_t seed, bool is_rover)
      : options_(options),
        orbits_(orbits),
        base_(geo::geodetic_from_ecef(r_base_e)),
        start_(start),
        seed_(stream_seed(seed, {is_rover ? 41U : 42U})),
        is_rover_(is_rover),
        draw_(stream_seed(seed_, {0})),
        wet_(stream_seed(seed_, {1}), 3600.0) {
    clock_ = {1e-4 * draw_(), 2e-8 * draw_()};
  }

  [[nodiscard]] const Clock& clock() const { return clock_; }
  /// @param t  true time since the start, s  @param tag  time by the receiver's clock, since the start: t plus its error
  record::ObservationEpoch observe(double t, double tag, const Kinematics& antenna, const std::vector<Satellite>& satellites,
                                   const std::map<int, int>& channels, std::vector<CycleSlip>& slips);

 private:
  /// Geometry, satellite clock and atmosphere, everything except the receiver's clock; at time t.
  struct Way {
    double metres = 0.0;  ///< of a signal without ionosphere
    double ionosphere = 0.0;
    carrier::Direction direction;
    double wind_up = 0.0;  ///< cycles
  };
  struct Rate {
    double metres = 0.0, wind_up = 0.0;  ///< per s
  };
  [[nodiscard]] std::optional<Way> way(Satellite satellite, double t, const Kinematics& antenna, double wet) const;
  [[nodiscard]] bool hidden(double t, const carrier::Direction& direction) const;
  record::Observation observe(Satellite satellite, record::Signal signal, double frequency, double t, double tag,
                              const Way& now, const Rate& rate, std::vector<CycleSlip>& slips);
  GaussMarkov& process(std::map<std::pair<Satellite, char>, GaussMarkov>& all, Satellite satellite, char band,
                       std::uint64_t stream) {
    const auto found = all.find({satellite, band});
    if (found != all.end()) return found->second;
    const std::uint64_t own = stream_seed(
        seed_, {stream, static_cast<std::uint64_t>(satellite.system), satellite.number, static_cast<std::uint64_t>(band)});
    return all.emplace(std::pair(satellite, band), GaussMarkov(own, options_.multipath_time)).first->second;
  }

  const ObservationOptions& options_;
  const carrier::BroadcastOrbits& orbits_;
  geo::Geodetic base_;
  geo::GpsTime start_;
  std::uint64_t seed_;
  bool is_rover_;
  Normal draw_;
  GaussMarkov wet_;
  Clock clock_;
  std::map<std::pair<Satellite, char>, GaussMarkov> code_multipath_, phase_multipath_;
  std::map<std::pair<Satellite, char>, PhaseLock> locks_;
  std::map<Satellite, double> wind_ups_;  ///< of the previous epoch
};

std::optional<Receiver::Way> Receiver::way(Satellite satellite, double t, const Kinematics& antenna, double wet) const {
  // In inertial axes that agree with ECEF at reception: the satellite's position at transmission is rotated back by omega tau.
  double tau = 0.075;
  carrier::SatelliteState state;
  const Eigen::Vector3d& r_e = antenna.r_eb_e;
  Eigen::Vector3d r_satellite_e;
  for (int i = 0; i < 5; ++i) {
    const std::optional<carrier::SatelliteState> at = orbits_.at(satellite, start_ + (t - tau));
    if (!at) return std::nullopt;
    state = *at;
    r_satellite_e = Eigen::AngleAxisd(-geo::kEarthRate * tau, Eigen::Vector3d::UnitZ()) * state.r_e;
    tau = (r_satellite_e - r_e).norm() / kSpeedOfLight;
  }
  Way w;
  w.direction = carrier::direction_of(r_satellite_e, r_e);
  if (w.direction.elevation < options_.elevation_mask) return std::nullopt;
  const geo::Geodetic receiver = geo::geodetic_from_ecef(r_e);
  const carrier::ZenithDelay zenith = carrier::zenith_delay(carrier::surface_weather(receiver, start_ + t), receiver);
  const carrier::TroposphericMapping mapping = carrier::niell_mapping(receiver, w.direction.elevation, start_ + t);
  const auto wound = wind_ups_.find(satellite);
  w.wind_up = carrier::wind_up(r_satellite_e, carrier::sun_e(start_ + t), r_e, antenna.C_b_e,
                               wound == wind_ups_.end() ? 0.0 : wound->second);
  w.metres =
      kSpeedOfLight * (tau - state.clock_s) + mapping.hydrostatic * zenith.hydrostatic + mapping.wet * (zenith.wet + wet);
  // A thin layer at 450 km; its vertical delay increases towards the equator.
  constexpr double kEarth = 6371e3, kLayer = 450e3;
  const double sine = kEarth / (kEarth + kLayer) * std::cos(w.direction.elevation);
  const double south = kEarth * (base_.latitude - receiver.latitude);
  w.ionosphere = (options_.vertical_delay + options_.ionosphere_gradient * south) / std::sqrt(1.0 - sine * sine);
  return w;
}

bool Receiver::hidden(double t, const carrier::Direction& direction) const {
  if (!is_rover_) return false;
  return std::ranges::any_of(options_.obstacles, [&](const Obstacle& o) {
    if (!o.when.contains(t) || direction.elevation >= o.elevation) return false;
    const bool behind = direction.azimuth >= o.azimuth_from, before = direction.azimuth <= o.azimuth_to;
    return o.azimuth_from <= o.azimuth_to ? behind && before : behind || before;
  });
}

record::Observation Receiver::observe(Satellite satellite, record::Signal signal, double frequency, double t, double tag,
                                      const Way& now, const Rate& rate, std::vector<CycleSlip>& slips) {
  constexpr double kMillimetre = 1e-3, kThousandth = 1e-3;
  constexpr double kLost = 1.5;  // epochs
  const double wavelength = kSpeedOfLight / frequency;
  const double growth = 1.0 / std::sin(now.direction.elevation);
  const double dispersion = carrier::kL1Frequency / frequency * carrier::kL1Frequency / frequency;
  const double metres = now.metres + kSpeedOfLight * (tag - t);
  record::Observation o;
  o.satellite = satellite;
  o.signal = signal;
  const double code_error = growth * (options_.code_sd * draw_() +
                                      options_.code_multipath_sd * process(code_multipath_, satellite, signal.band, 2).at(t));
  const double phase_error =
      growth *
      (options_.phase_sd * draw_() + options_.phase_multipath_sd * process(phase_multipath_, satellite, signal.band, 3).at(t));
  PhaseLock& lock = locks_[{satellite, signal.band}];
  const double interval = 1.0 / (is_rover_ ? options_.rate_hz : options_.base_rate_hz);
  if (tag - lock.last > kLost * interval) {
    lock.cycles = std::round(1e6 * draw_());
    o.lost_lock = lock.last >= 0.0;  // the first epoch of a file has no flag
  } else if (is_rover_) {
    const double u = 0.5 * std::erfc(-draw_() / std::numbers::sqrt2), share = 0.5 * std::erfc(-draw_() / std::numbers::sqrt2);
    const double size = 1.0 + std::floor(20.0 * 0.5 * std::erfc(-draw_() / std::numbers::sqrt2));
    if (u < options_.slips_per_hour * interval / 3600.0) {
      lock.cycles += size;
      o.lost_lock = share < options_.flagged_share;
      slips.push_back({start_ + tag, satellite, signal.band, static_cast<int>(size), o.lost_lock});
    }
  }
  lock.last = tag;
  o.code_m = std::round((metres + dispersion * now.ionosphere + code_error) / kMillimetre) * kMillimetre;
  const double phase = (metres - dispersion * now.ionosphere + phase_error) / wavelength + lock.cycles + now.wind_up;
  o.phase_cycles = std::round(phase / kThousandth) * kThousandth;
  const double doppler = -(rate.metres + kSpeedOfLight * clock_.drift) / wavelength - rate.wind_up;
  o.doppler_hz = std::round((doppler + 0.02 * draw_()) / kMillimetre) * kMillimetre;
  o.cn0_dbhz = std::round(10.0 * (50.0 + 10.0 * std::log10(std::sin(now.direction.elevation)) + 0.5 * draw_())) / 10.0;
  return o;
}

/// Extrapolated to slightly later or earlier times.
Kinematics moved(Kinematics antenna, double dt) {
  antenna.r_eb_e += dt * antenna.v_eb_e;
  const Eigen::Vector3d angle = dt * antenna.omega_eb_b;
  antenna.C_b_e *= Eigen::AngleAxisd(angle.norm(), angle.stableNormalized()).toRotationMatrix();
  return antenna;
}

record::ObservationEpoch Receiver::observe(double t, double tag, const Kinematics& antenna,
                                           const std::vector<Satellite>& satellites, const std::map<int, int>& channels,
                                           std::vector<CycleSlip>& slips) {
  record::ObservationEpoch epoch;
  epoch.t = start_ + tag;
  const double wet = is_rover_ ? options_.wet_zenith_sd * wet_.at(t) : 0.0;
  for (const Satellite satellite : satellites) {
    const std::optional<Way> now = way(satellite, t, antenna, wet);
    if (!now || hidden(tag, now->direction)) continue;
    constexpr double kStep = 0.01;  // s
    const std::optional<Way> soon = way(satellite, t + kStep, moved(antenna, kStep), wet);
    const std::optional<Way> ago = way(satellite, t - kStep, moved(antenna, -kStep), wet);
    Rate rate;
    if (soon && ago) rate = {(soon->metres - ago->metres) / (2.0 * kStep), (soon->wind_up - ago->wind_up) / (2.0 * kStep)};
    wind_ups_[satellite] = now->wind_up;
    const auto channel = channels.find(satellite.number);
    for (const record::Signal signal : signals_of(satellite.system)) {
      const double frequency =
          *carrier::carrier_frequency(satellite.system, signal.band, channel == channels.end() ? 0 : channel->second);
      epoch.observations.push_back(observe(satellite, signal, frequency, t, tag, *now, rate, slips));
    }
  }
  return epoch;
}

Kinematics standing_upright(const Eigen::Vector3d& r_e) {
  Kinematics antenna;
  antenna.r_eb_e = r_e;
  antenna.v_eb_e = antenna.a_eb_e = antenna.omega_eb_b = antenna.alpha_eb_b = Eigen::Vector3d::Zero();
  antenna.C_b_e = geo::C_n_e(geo::geodetic_from_ecef(r_e));
  return antenna;
}

void check(const ObservationOptions& o) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(fmt::format("ObservationOptions: {}", what));
  };
  require(o.rate_hz >= 0.001 && o.rate_hz <= 100.0 && o.base_rate_hz >= 0.001 && o.base_rate_hz <= 100.0,
          "rates are 0.001 to 100 Hz");
  require(
      std::min({o.code_sd, o.phase_sd, o.code_multipath_sd, o.phase_multipath_sd, o.wet_zenith_sd, o.slips_per_hour}) >= 0.0,
      "an sd or a number of slips is below zero");
  require(o.multipath_time > 0.0, "multipath_time is above zero");
  require(o.elevation_mask >= 0.03, "elevation_mask is at least 0.03 rad");
}

}  // namespace

SimulatedObservations simulate_observations(const AnalyticTrajectory& motion, geo::GpsTime start,
                                            const ObservationOptions& options, std::uint64_t seed) {
  check(options);
  SimulatedObservations result;
  result.navigation = constellation(options.systems, start, start + motion.duration(), seed);
  const carrier::BroadcastOrbits orbits(result.navigation);
  const geo::LocalFrame frame(motion.plan().origin);
  result.r_base_e = frame.to_ecef(options.base_n);
  std::vector<Satellite> satellites;
  for (const auto& e : result.navigation.kepler) satellites.push_back(e.satellite);
  std::map<int, int> channels;
  for (const auto& e : result.navigation.tabulated) {
    satellites.push_back(e.satellite);
    if (e.satellite.system == SatelliteSystem::kGlonass) channels[e.satellite.number] = e.channel;
  }
  std::ranges::sort(satellites);
  satellites.erase(std::unique(satellites.begin(), satellites.end()), satellites.end());
  for (const bool is_rover : {true, false}) {
    record::ObservationRecording& recording = is_rover ? result.rover : result.base;
    recording.source = recording.marker = is_rover ? "ROVER" : "BASE";
    recording.receiver = "SIMULATED";
    recording.glonass_channels = channels;
    Receiver receiver(options, orbits, result.r_base_e, start, seed, is_rover);
    const double rate = is_rover ? options.rate_hz : options.base_rate_hz;
    for (long k = 0;; ++k) {
      const double tag = static_cast<double>(k) / rate;
      const double t = tag - receiver.clock().at(tag);
      if (tag > motion.duration() || t > motion.duration()) break;
      const Kinematics antenna =
          is_rover ? at_point(motion.at(std::max(t, 0.0)), options.lever_arm_b) : standing_upright(result.r_base_e);
      recording.epochs.push_back(receiver.observe(std::max(t, 0.0), tag, antenna, satellites, channels, result.slips));
    }
    recording.approximate_r_e = is_rover ? at_point(motion.at(0.0), options.lever_arm_b).r_eb_e : result.r_base_e;
  }
  return result;
}

}  // namespace coast::simulate
