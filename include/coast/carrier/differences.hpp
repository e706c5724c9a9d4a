#pragma once
// What a rover measured, corrected by a base: differences between receivers, the satellites' errors gone.

#include <functional>
#include <map>
#include <set>

#include "coast/carrier/antennas.hpp"
#include "coast/carrier/single_point.hpp"

namespace coast::carrier {

/// One band of one satellite, m: the rover's observation less what the base's, interpolated to the rover's epoch, differs from
/// the model at the base's position. What is left is the rover's range (SignalPath::modelled) and clocks, what the air does
/// differently on both ways, and the difference of the ambiguities.
struct BandDifference {
  char band = '1';
  double frequency = 0.0;  ///< Hz
  std::optional<double> code;
  std::optional<double> phase;
  std::optional<double> rate;              ///< by Doppler, m/s; the rover's modelled_rate is left in it
  double rover_cn0 = 0.0, base_cn0 = 0.0;  ///< dB-Hz, 0 where unknown
  bool half_cycle = false;                 ///< the ambiguity may be half an integer
  int arc = 0;                             ///< of this satellite and band: another number, another ambiguity

  [[nodiscard]] double wavelength() const;
};

struct SatelliteDifference {
  record::Satellite satellite;
  SatelliteState state;  ///< at transmission to the rover
  double base_elevation = 0.0;
  std::vector<BandDifference> bands;  ///< by band
};

struct DifferenceEpoch {
  geo::GpsTime t;               ///< as the rover's clock showed it
  std::optional<double> age_s;  ///< from the nearest epoch of the base; none: no base
  Eigen::Vector3d r_base_e = Eigen::Vector3d::Zero();
  std::optional<SinglePoint> alone;  ///< the rover by itself
  int seen = 0;                      ///< satellites that the rover saw
  std::vector<SatelliteDifference> satellites;
};

/// What one tracks on the same band need not be what the other does.
struct SignalPair {
  char rover = 'C', base = 'C';
};
using SignalChoice = std::map<std::pair<record::SatelliteSystem, char>, SignalPair>;
/// Of each system and band the pair of signals that gives most common observations; equal ones where there is a choice.
[[nodiscard]] SignalChoice choose_signals(const record::ObservationRecording& rover, const record::ObservationRecording& base,
                                          const std::set<record::SatelliteSystem>& systems);

/// The base's antenna at an instant, ECEF, m; none where it is not known then.
using BasePosition = std::function<std::optional<Eigen::Vector3d>(geo::GpsTime)>;

struct DifferenceOptions {
  std::set<record::SatelliteSystem> systems{record::SatelliteSystem::kGps, record::SatelliteSystem::kGalileo,
                                            record::SatelliteSystem::kQzss, record::SatelliteSystem::kBeidou,
                                            record::SatelliteSystem::kGlonass};
  AirModel air;
  double elevation_mask = 0.17453292519943295;  ///< rad, at the rover's and the base's
  double longest_base_gap_s = 90.0;             ///< over which the base is interpolated
  /// Calibrations of the antennas; absent: their phase centres are taken for the points that positions mean.
  std::optional<record::AntennaCalibration> rover_antenna, base_antenna;
};

/// Every epoch of the rover. Arcs end at loss of lock, at a change of the half-cycle flag, behind gaps, and where the
/// difference of two bands' phases (geometry-free) jumps; they are the same forward and backward in time.
[[nodiscard]] std::vector<DifferenceEpoch> form_differences(const record::ObservationRecording& rover,
                                                            const record::ObservationRecording& base,
                                                            const SignalChoice& signals, const Orbits& orbits,
                                                            const BasePosition& base_position,
                                                            const DifferenceOptions& options);

/// One receiver's single-point solutions, epoch by epoch, from the systems of the options.
[[nodiscard]] std::vector<std::optional<SinglePoint>> single_points(const record::ObservationRecording& receiver,
                                                                    const Orbits& orbits, const DifferenceOptions& options);

/// Median step between epochs, s; 0 with fewer than two.
[[nodiscard]] double interval_of(const record::ObservationRecording& receiver);

}  // namespace coast::carrier
