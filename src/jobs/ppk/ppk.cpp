#include "coast/jobs/ppk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "coast/io/products.hpp"
#include "coast/io/rinex.hpp"
#include "common/tell.hpp"

namespace coast::jobs {

namespace {

using record::ObservationRecording;

void append(const record::Events& more, record::Events& events) {
  events.insert(events.end(), more.begin(), more.end());
}

/// nullptr if only the navigation message is available.
std::unique_ptr<const carrier::Orbits> precise_orbits(PpkRecordings& recordings, record::Events& events) {
  if (!recordings.precise) return nullptr;
  append(recordings.precise->events, events);
  append(recordings.clocks.events, events);
  return std::make_unique<carrier::PreciseEphemerides>(std::move(*recordings.precise), std::move(recordings.clocks));
}

/// Frequency channels from the navigation message, if they are missing in the files of a GLONASS rover.
void add_channels(const record::NavigationRecording& navigation, ObservationRecording& receiver) {
  for (const record::TabulatedEphemeris& e : navigation.tabulated)
    if (e.satellite.system == record::SatelliteSystem::kGlonass)
      receiver.glonass_channels.emplace(e.satellite.number, e.channel);
}

/// The calibrations of both antennas. If one has none neither is used: their common part would no longer cancel.
void add_antennas(const record::AntennaTable& table, const ObservationRecording& rover, const ObservationRecording& base,
                  carrier::DifferenceOptions& options, record::Events& events) {
  const record::AntennaCalibration* of_rover = carrier::find_antenna(table, rover.antenna);
  const record::AntennaCalibration* of_base = carrier::find_antenna(table, base.antenna);
  if (of_rover != nullptr && of_base != nullptr) {
    options.rover_antenna = *of_rover;
    options.base_antenna = *of_base;
    return;
  }
  const ObservationRecording& without = of_rover == nullptr ? rover : base;
  events.push_back(
      {record::Event::Severity::kWarning, "antenna_unknown",
       fmt::format("{}: no antenna \"{}\" of {}; phase centres are left out", table.source, without.antenna, without.source),
       std::nullopt, 1});
}

/// Orbits of another day would make everything else appear wrong.
void require_orbits(const ObservationRecording& rover, const carrier::Orbits& orbits, const std::string& source, bool precise) {
  constexpr std::size_t kEpochs = 10;
  const std::size_t step = std::max<std::size_t>(1, rover.epochs.size() / kEpochs);
  for (std::size_t i = 0; i < rover.epochs.size(); i += step)
    for (const record::Observation& o : rover.epochs[i].observations)
      if (orbits.at(o.satellite, rover.epochs[i].t)) return;
  throw InputError({source, 0,
                    fmt::format("no orbit of a satellite of {} at {}", rover.source, geo::to_string(rover.epochs.front().t)),
                    precise ? "orbits of the same hours" : "ephemerides of the same hours",
                    precise ? "Give the SP3 files of the same day." : "Give the navigation file of the same day."});
}

std::string in_words(const ObservationRecording& receiver) {
  return fmt::format("{} ({}{}{})", receiver.marker.empty() ? "unnamed" : receiver.marker,
                     receiver.receiver.empty() ? "receiver not stated" : receiver.receiver,
                     receiver.antenna.empty() ? "" : ", ", receiver.antenna);
}

}  // namespace

PpkRecordings load(const PpkConfig& config) {
  PpkRecordings recordings;
  recordings.navigation = io::read_navigation(config.navigation);
  const auto near = io::middle_of(recordings.navigation);
  recordings.rover = io::read_observations(config.rover, near);
  recordings.base = io::read_observations(config.base, near);
  if (!config.sp3.empty()) recordings.precise = io::read_sp3(config.sp3);
  if (recordings.precise && !config.clocks.empty()) recordings.clocks = io::read_clocks(config.clocks);
  if (config.antex) recordings.antennas = io::read_antex(*config.antex);
  return recordings;
}

PpkResult ppk(const PpkConfig& config, const Progress& progress) {
  progress("reading", 0.0);
  return ppk(config, load(config), progress);
}

PpkResult ppk(const PpkConfig& config, PpkRecordings recordings, const Progress& progress) {
  PpkResult result;
  ObservationRecording& rover = recordings.rover;
  ObservationRecording& base = recordings.base;
  if (carrier::same_observations(rover, base))
    throw InputError({base.source, 0, "the observations of the rover", "those of another receiver",
                      fmt::format("`rover` is {}: one of the two is not the file that was meant.", rover.source)});
  const record::NavigationRecording& navigation = recordings.navigation;
  add_channels(navigation, rover);
  add_channels(navigation, base);
  const carrier::BroadcastOrbits broadcast(navigation);
  const std::unique_ptr<const carrier::Orbits> precise = precise_orbits(recordings, result.events);
  const record::AntennaTable antennas = recordings.antennas.value_or(record::AntennaTable{});
  append(antennas.events, result.events);
  std::optional<carrier::PhaseCentredOrbits> centred;
  if (precise) centred.emplace(*precise, antennas);
  const carrier::Orbits& orbits = centred ? static_cast<const carrier::Orbits&>(*centred) : broadcast;
  require_orbits(rover, orbits, centred && !config.sp3.empty() ? config.sp3.front().string() : navigation.source,
                 centred.has_value());
  carrier::PpkOptions options = config.options;
  if (config.broadcast_ionosphere) options.differences.air.ionosphere = navigation.gps_ionosphere;
  result.rover = in_words(rover);
  result.base = in_words(base);
  const carrier::KnownBase known = carrier::known_base(config.base_at, base, orbits, options.differences);
  result.r_base_e = known.r_e;
  result.base_from = known.from;
  append(carrier::examine_base(config.base_at, known, base, orbits, options.differences), result.events);
  if (options.motion == carrier::RoverMotion::kStatic)
    append(carrier::examine_static_rover(rover, orbits, options.differences), result.events);
  if (recordings.antennas) add_antennas(antennas, rover, base, options.differences, result.events);
  result.solution =
      carrier::solve_ppk(rover, base, orbits, known.at, options, [&progress](double share) { progress("solving", share); });
  result.options = std::move(options);
  result.fixes = carrier::to_fixes(result.solution, rover.source);
  for (const record::Events& events : {rover.events, base.events, navigation.events, broadcast.events(), result.fixes.events})
    append(events, result.events);
  if (config.projection && !result.fixes.fixes.empty()) {
    config.projection->choose(result.fixes.fixes.front().r_ea_e);
    append(config.projection->events(), result.events);
  }
  tell_warnings(result.events, progress);
  return result;
}

}  // namespace coast::jobs
