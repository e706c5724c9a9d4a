#pragma once
// Single differences between rover and base: satellite errors cancel.

#include <functional>
#include <map>
#include <set>

#include "coast/carrier/antennas.hpp"
#include "coast/carrier/single_point.hpp"

namespace coast::carrier {

/// One band of one satellite, m: the rover's observation minus the difference of the base's observation, interpolated to the
/// rover's epoch, from the model at the base position. It contains the rover's range (SignalPath::modelled), the clocks, the
/// differential atmospheric delays, and the difference of the ambiguities.
struct BandDifference {
  char band = '1';
  double frequency = 0.0;  ///< Hz
  std::optional<double> code;
  std::optional<double> phase;
  std::optional<double> rate;              ///< from Doppler, m/s; contains the rover's modelled_rate
  double rover_cn0 = 0.0, base_cn0 = 0.0;  ///< dB-Hz, 0 where unknown
  bool half_cycle = false;                 ///< the ambiguity may be half an integer
  int arc = 0;                             ///< of this satellite and band: a new number means a new ambiguity

  [[nodiscard]] double wavelength() const;
};

struct SatelliteDifference {
  record::Satellite satellite;
  SatelliteState state;  ///< at transmission to the rover
  double base_elevation = 0.0;
  std::vector<BandDifference> bands;  ///< by band
};

struct DifferenceEpoch {
  geo::GpsTime t;               ///< by the rover's clock
  std::optional<double> age_s;  ///< relative to the nearest epoch of the base; none: no base
  Eigen::Vector3d r_base_e = Eigen::Vector3d::Zero();
  std::optional<SinglePoint> alone;  ///< single-point position of the rover
  int seen = 0;                      ///< number of satellites tracked by the rover
  std::vector<SatelliteDifference> satellites;
};

/// Tracking codes of rover and base on one band; they may differ.
struct SignalPair {
  char rover = 'C', base = 'C';
};
using SignalChoice = std::map<std::pair<record::SatelliteSystem, char>, SignalPair>;
/// For each system and band the pair of signals with the most common observations; equal tracking codes are preferred.
[[nodiscard]] SignalChoice choose_signals(const record::ObservationRecording& rover, const record::ObservationRecording& base,
                                          const std::set<record::SatelliteSystem>& systems);

/// The base's antenna at an instant, ECEF, m; none if it is not known then.
using BasePosition = std::function<std::optional<Eigen::Vector3d>(geo::GpsTime)>;

struct DifferenceOptions {
  std::set<record::SatelliteSystem> systems{record::SatelliteSystem::kGps, record::SatelliteSystem::kGalileo,
                                            record::SatelliteSystem::kQzss, record::SatelliteSystem::kBeidou,
                                            record::SatelliteSystem::kGlonass};
  AirModel air;
  double elevation_mask = 0.17453292519943295;  ///< rad, at rover and base
  double longest_base_gap_s = 90.0;             ///< longest gap over which the base is interpolated
  /// Calibrations of the antennas; absent: positions refer to the phase centres.
  std::optional<record::AntennaCalibration> rover_antenna, base_antenna;
};

/// Every epoch of the rover. Arcs end at loss of lock, at a change of the half-cycle flag, at gaps, and where the geometry-free
/// phase difference of two bands jumps; they are the same forward and backward in time.
[[nodiscard]] std::vector<DifferenceEpoch> form_differences(const record::ObservationRecording& rover,
                                                            const record::ObservationRecording& base,
                                                            const SignalChoice& signals, const Orbits& orbits,
                                                            const BasePosition& base_position,
                                                            const DifferenceOptions& options);

/// Single-point solutions of one receiver, epoch by epoch, from the systems of the options.
[[nodiscard]] std::vector<std::optional<SinglePoint>> single_points(const record::ObservationRecording& receiver,
                                                                    const Orbits& orbits, const DifferenceOptions& options);

/// Median step between epochs, s; 0 with fewer than two.
[[nodiscard]] double interval_of(const record::ObservationRecording& receiver);

}  // namespace coast::carrier
