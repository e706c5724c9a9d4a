#pragma once
// Positions and clocks of satellites, from broadcast ephemerides or precise products.

#include <map>
#include <optional>
#include <vector>

#include "coast/record/antenna.hpp"
#include "coast/record/navigation.hpp"
#include "coast/record/precise_orbits.hpp"

namespace coast::carrier {

struct SatelliteState {
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();  ///< antenna's phase centre, in the ECEF of time t, m
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();  ///< m/s
  double clock_s = 0.0;     ///< relative to system time, positive ahead; with relativity, without group delays
  double clock_rate = 0.0;  ///< s/s
};

/// GPS, QZSS: IS-GPS-200 20.3.3.4.3; Galileo: OS SIS ICD 5.1.1; BeiDou, with its geostationary satellites:
/// BDS-SIS-ICD-B1I 5.2.4.
/// @param t  of transmission, GPS time. The time group delay of the user's signal is not subtracted.
[[nodiscard]] SatelliteState satellite_state(const record::KeplerEphemeris& ephemeris, geo::GpsTime t);
/// GLONASS: ICD 5.1 annex A.3.1.2, fourth-order Runge-Kutta with steps of at most 60 s; SBAS: RTCA DO-229 A.4.4.11.
[[nodiscard]] SatelliteState satellite_state(const record::TabulatedEphemeris& ephemeris, geo::GpsTime t);

/// Interface to the satellite positions of a mission, from any source.
class Orbits {
 public:
  virtual ~Orbits() = default;
  /// @param t  of transmission, GPS time; none if the satellite has no orbit at that time
  [[nodiscard]] virtual std::optional<SatelliteState> at(record::Satellite satellite, geo::GpsTime t) const = 0;
};

/// The broadcast ephemerides of a mission. Unhealthy satellites have none. An ephemeris that differs by 100 km from the
/// previous and the next one, which agree with each other, has a wrong satellite number or is damaged: it is left out, with an
/// event.
class BroadcastOrbits : public Orbits {
 public:
  explicit BroadcastOrbits(const record::NavigationRecording& navigation);

  /// From the nearest valid ephemeris (2 h for GPS and QZSS, 15 min for GLONASS, 6 min for SBAS; Galileo 4 h and BeiDou 1 h
  /// after the reference time, a quarter of that before it); for Galileo I/NAV if both are present.
  [[nodiscard]] std::optional<SatelliteState> at(record::Satellite satellite, geo::GpsTime t) const override;
  /// The Keplerian ephemeris that `at` would use: for group delays, accuracy and issue.
  [[nodiscard]] const record::KeplerEphemeris* kepler_at(record::Satellite satellite, geo::GpsTime t) const;
  [[nodiscard]] const record::TabulatedEphemeris* tabulated_at(record::Satellite satellite, geo::GpsTime t) const;
  [[nodiscard]] const record::Events& events() const { return events_; }

 private:
  void leave_out_strangers(record::Satellite satellite, std::vector<record::KeplerEphemeris>& ephemerides);

  std::map<record::Satellite, std::vector<record::KeplerEphemeris>> kepler_;
  std::map<record::Satellite, std::vector<record::TabulatedEphemeris>> tabulated_;
  record::Events events_;
};

/// Orbits and clocks of the analysis centres: positions by a polynomial through ten points of the table (Schenewerk 2003),
/// clocks linearly from the clock files or, without them, the orbit files; the periodic relativistic effect is added
/// (IS-GPS-200 20.3.3.3.3.1). Positions are of the centre of mass: phase centres (PhaseCentredOrbits) are up to 3 m closer to
/// the Earth, which matters by a millimetre over a 10 km baseline.
class PreciseEphemerides : public Orbits {
 public:
  /// @param clocks  may be empty
  PreciseEphemerides(record::PreciseOrbits orbits, record::PreciseClocks clocks);
  /// None before the first and after the last point, near gaps, and without a clock.
  [[nodiscard]] std::optional<SatelliteState> at(record::Satellite satellite, geo::GpsTime t) const override;

 private:
  record::PreciseOrbits orbits_;
  record::PreciseClocks clocks_;
};

/// Axes of a yaw-steering satellite, as columns, in ECEF: z to the geocentre, y along the solar panels (z x Sun), x towards the
/// Sun side (Montenbruck et al. 2015, the IGS convention); without noon, midnight and shadow turns.
[[nodiscard]] Eigen::Matrix3d yaw_steering_axes(const Eigen::Vector3d& r_satellite_e, const Eigen::Vector3d& r_sun_e);

/// Orbits of centres of mass reduced to the antenna phase centres with the satellite calibrations valid at the time (ANTEX),
/// for the ionosphere-free combination of the first two bands, to which clocks of the analysis centres refer. Satellites
/// without a calibration are not corrected.
class PhaseCentredOrbits : public Orbits {
 public:
  /// @param centres_of_mass  must outlive this
  PhaseCentredOrbits(const Orbits& centres_of_mass, const record::AntennaTable& table);
  [[nodiscard]] std::optional<SatelliteState> at(record::Satellite satellite, geo::GpsTime t) const override;

 private:
  struct Offset {
    std::optional<geo::GpsTime> from, until;
    Eigen::Vector3d value;  ///< body axes, m
  };
  const Orbits& centres_of_mass_;
  std::map<record::Satellite, std::vector<Offset>> offsets_;
};

}  // namespace coast::carrier
