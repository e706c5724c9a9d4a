#include "ppk_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "coast/geo/earth.hpp"
#include "coast/io/products.hpp"
#include "coast/io/rinex.hpp"
#include "coast/record/error.hpp"
#include "coast/study/paired.hpp"

namespace coast::cli {

namespace {

using record::ObservationRecording;

/// Files of GLONASS rovers may leave the frequencies to the navigation message.
void add_channels(const record::NavigationRecording& navigation, ObservationRecording& receiver) {
  for (const record::TabulatedEphemeris& e : navigation.tabulated)
    if (e.satellite.system == record::SatelliteSystem::kGlonass)
      receiver.glonass_channels.emplace(e.satellite.number, e.channel);
}

/// The antenna of a receiver whose marker is known.
Eigen::Vector3d antenna(const ObservationRecording& receiver, const Eigen::Vector3d& r_marker_e) {
  const Eigen::Vector3d& enu = receiver.antenna_offset_enu;
  return r_marker_e + geo::C_n_e(geo::geodetic_from_ecef(r_marker_e)) * Eigen::Vector3d(enu.y(), enu.x(), -enu.z());
}

/// Where a receiver is by itself, epoch by epoch.
std::vector<std::pair<geo::GpsTime, Eigen::Vector3d>> own_positions(const ObservationRecording& receiver,
                                                                    const carrier::Orbits& orbits,
                                                                    const carrier::DifferenceOptions& options) {
  std::vector<std::pair<geo::GpsTime, Eigen::Vector3d>> positions;
  const auto points = carrier::single_points(receiver, orbits, options.air, options.elevation_mask);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i]) positions.emplace_back(receiver.epochs[i].t, points[i]->r_e);
  if (positions.empty())
    throw InputError({receiver.source, 0, "no epoch with a position of its own", "codes of four satellites or more",
                      "Give base_position: {ecef_m: [x, y, z]}."});
  return positions;
}

Eigen::Vector3d mean(const std::vector<std::pair<geo::GpsTime, Eigen::Vector3d>>& positions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [t, r_e] : positions) sum += r_e;
  return sum / static_cast<double>(positions.size());
}

/// Sets the base's position of the result and gives it for any time.
carrier::BasePosition base_position(const PpkConfig& config, const ObservationRecording& base, const carrier::Orbits& orbits,
                                    PpkResult& result) {
  switch (config.base_at.how) {
    case BaseAt::How::kGiven:
      result.r_base_e = antenna(base, config.base_at.r_e);
      result.base_from = "given in the configuration";
      break;
    case BaseAt::How::kHeader:
      if (!base.approximate_r_e)
        throw InputError({base.source, 0, "no APPROX POSITION XYZ in the header", "the base's position",
                          "Give base_position: {ecef_m: [x, y, z]}, or base_position: average."});
      result.r_base_e = antenna(base, *base.approximate_r_e);
      result.base_from = "of the file's header, which may be metres off";
      break;
    case BaseAt::How::kAveraged: {
      const auto positions = own_positions(base, orbits, config.options.differences);
      result.r_base_e = mean(positions);
      result.base_from = fmt::format("the mean of its {} single-point positions, metres off", positions.size());
      break;
    }
    case BaseAt::How::kMoving: {
      auto positions = std::make_shared<const std::vector<std::pair<geo::GpsTime, Eigen::Vector3d>>>(
          own_positions(base, orbits, config.options.differences));
      result.r_base_e = positions->front().second;
      result.base_from = "moving: its own single-point positions, metres off, the baseline is not";
      return [positions](geo::GpsTime t) -> std::optional<Eigen::Vector3d> {
        const auto at = std::ranges::lower_bound(*positions, t, {}, [](const auto& p) { return p.first; });
        return at != positions->end() && at->first == t ? std::optional(at->second) : std::nullopt;
      };
    }
  }
  return [r_e = result.r_base_e](geo::GpsTime) { return std::optional(r_e); };
}

/// The calibrations of both antennas. Where one has none neither is used: what both have in common would no longer cancel.
void add_antennas(const std::filesystem::path& file, const ObservationRecording& rover, const ObservationRecording& base,
                  carrier::DifferenceOptions& options, record::Events& events) {
  const record::AntennaTable table = io::read_antex(file);
  events.insert(events.end(), table.events.begin(), table.events.end());
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

/// Median step between epochs, s.
double interval(const ObservationRecording& receiver) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < receiver.epochs.size(); ++i) steps.push_back(receiver.epochs[i].t - receiver.epochs[i - 1].t);
  return steps.empty() ? 0.0 : study::quantile(std::move(steps), 0.5);
}

std::string in_words(const ObservationRecording& receiver) {
  return fmt::format("{} ({}{}{})", receiver.marker.empty() ? "unnamed" : receiver.marker,
                     receiver.receiver.empty() ? "receiver not stated" : receiver.receiver,
                     receiver.antenna.empty() ? "" : ", ", receiver.antenna);
}

}  // namespace

PpkResult run_ppk(const PpkConfig& config, const std::function<void(double)>& progress) {
  ObservationRecording rover = io::read_observations(config.rover);
  ObservationRecording base = io::read_observations(config.base);
  const record::NavigationRecording navigation = io::read_navigation(config.navigation);
  add_channels(navigation, rover);
  add_channels(navigation, base);
  const carrier::BroadcastOrbits broadcast(navigation);
  std::optional<carrier::PreciseEphemerides> precise;
  if (!config.sp3.empty())
    precise.emplace(io::read_sp3(config.sp3), config.clocks.empty() ? record::PreciseClocks{} : io::read_clocks(config.clocks));
  const carrier::Orbits& orbits = precise ? static_cast<const carrier::Orbits&>(*precise) : broadcast;
  carrier::PpkOptions options = config.options;
  if (config.broadcast_ionosphere) options.differences.air.ionosphere = navigation.gps_ionosphere;
  PpkResult result;
  result.rover = in_words(rover);
  result.base = in_words(base);
  result.interval_s = interval(rover);
  const carrier::BasePosition position = base_position(config, base, orbits, result);
  if (config.antex) add_antennas(*config.antex, rover, base, options.differences, result.events);
  result.solution = carrier::solve_ppk(rover, base, orbits, position, options, progress);
  const std::array<const record::Events*, 5> all{&rover.events, &base.events, &navigation.events, &broadcast.events(),
                                                 &result.solution.events};
  for (const record::Events* events : all) result.events.insert(result.events.end(), events->begin(), events->end());
  return result;
}

}  // namespace coast::cli
