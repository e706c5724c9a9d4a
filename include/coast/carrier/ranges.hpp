#pragma once
// Signal path from a satellite's antenna to a receiver's antenna, and the modelled measurements.

#include "coast/carrier/atmosphere.hpp"
#include "coast/carrier/orbits.hpp"

namespace coast::carrier {

/// Which atmospheric delays are modelled.
struct AirModel {
  bool troposphere = true;                      ///< zenith_delay of the surface_weather, mapped after Niell
  std::optional<record::Klobuchar> ionosphere;  ///< for codes of a single receiver; not used for differences over baselines
  /// Ionosphere-free: single points from the ionosphere-free combination of two bands; for differences every satellite has its
  /// slant delay as a state without prior, which gives the same information as the ionosphere-free combination and keeps the
  /// ambiguities integer.
  bool ionosphere_free = false;
};

/// The satellite at transmission of the signal received at t, in the ECEF of that time. A pseudorange is the difference of two
/// clock readings, so t - P/c is the satellite's clock at transmission, whatever the receiver clock error.
/// @param t  by the receiver's clock @param pseudorange  m
[[nodiscard]] std::optional<SatelliteState> at_transmission(const Orbits& orbits, record::Satellite satellite, geo::GpsTime t,
                                                            double pseudorange);

/// Path from satellite to receiver.
struct SignalPath {
  double range = 0.0;                                         ///< m, with the Earth's rotation during travel (Sagnac)
  Eigen::Vector3d to_satellite_e = Eigen::Vector3d::UnitX();  ///< from the receiver
  Direction direction;
  double troposphere = 0.0;  ///< m
  double wet_mapping = 1.0;  ///< of the residual zenith delay

  /// Modelled part common to code and phase, without receiver clock, ionosphere and ambiguity, m.
  [[nodiscard]] double modelled(const SatelliteState& satellite) const;
};
/// @param satellite  at transmission  @param t  for the season  @param troposphere  whether it is modelled; below 1 degree of
///                   elevation it never is
[[nodiscard]] SignalPath path_to(const SatelliteState& satellite, const Eigen::Vector3d& r_receiver_e,
                                 const geo::Geodetic& receiver, geo::GpsTime t, bool troposphere);

/// Rate of the range to a satellite, with its clock rate and the Earth's rotation (Sagnac), m/s: the Doppler of a receiver
/// without clock drift.
[[nodiscard]] double modelled_rate(const SatelliteState& satellite, const Eigen::Vector3d& r_receiver_e,
                                   const Eigen::Vector3d& v_receiver_e);

}  // namespace coast::carrier
