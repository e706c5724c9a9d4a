#pragma once
// From a satellite's antenna to a receiver's: the way that a signal takes, and what a receiver at rest on it would measure.

#include "coast/carrier/atmosphere.hpp"
#include "coast/carrier/orbits.hpp"

namespace coast::carrier {

/// Which of the air's delays are modelled.
struct AirModel {
  bool troposphere = true;                      ///< zenith_delay of the surface_weather, mapped after Niell
  std::optional<record::Klobuchar> ionosphere;  ///< for codes of a single receiver; differences over baselines leave it out
  /// Ionosphere-free: single points by codes of two bands in which it cancels; of differences every satellite has its slant
  /// delay as a state of which nothing is known beforehand, which tells what the ionosphere-free combination does and keeps the
  /// ambiguities integers.
  bool ionosphere_free = false;
};

/// The satellite when it sent what the receiver got at t, in the ECEF of that time. A pseudorange is the difference of what
/// two clocks show, so t - P/c is the satellite's clock at transmission, however wrong the receiver's is.
/// @param t  as the receiver's clock showed it  @param pseudorange  m
[[nodiscard]] std::optional<SatelliteState> at_transmission(const Orbits& orbits, record::Satellite satellite, geo::GpsTime t,
                                                            double pseudorange);

/// The way from satellite to receiver.
struct SignalPath {
  double range = 0.0;                                         ///< m, with the Earth's rotation under way (Sagnac)
  Eigen::Vector3d to_satellite_e = Eigen::Vector3d::UnitX();  ///< from the receiver
  Direction direction;
  double troposphere = 0.0;  ///< m
  double wet_mapping = 1.0;  ///< of residual delay at the zenith

  /// What code and phase have in common but for the receiver's clock, ionosphere and ambiguity, m.
  [[nodiscard]] double modelled(const SatelliteState& satellite) const;
};
/// @param satellite  at transmission  @param t  for the season  @param troposphere  whether it is modelled: it is left out also
/// below 1 degree of elevation
[[nodiscard]] SignalPath path_to(const SatelliteState& satellite, const Eigen::Vector3d& r_receiver_e,
                                 const geo::Geodetic& receiver, geo::GpsTime t, bool troposphere);

/// Rate of the range to a satellite, with its clock's and the Earth's rotation (Sagnac), m/s: what the Doppler of a receiver
/// whose clock does not drift shows.
[[nodiscard]] double modelled_rate(const SatelliteState& satellite, const Eigen::Vector3d& r_receiver_e,
                                   const Eigen::Vector3d& v_receiver_e);

}  // namespace coast::carrier
