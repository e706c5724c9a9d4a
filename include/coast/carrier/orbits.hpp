#pragma once
// Where satellites are and what their clocks show, from broadcast ephemerides.

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
  double clock_s = 0.0;                           ///< ahead of the system's time; with relativity, without group delays
  double clock_rate = 0.0;                        ///< s/s
};

/// GPS, QZSS: IS-GPS-200 20.3.3.4.3; Galileo: OS SIS ICD 5.1.1; BeiDou, with its geostationary satellites:
/// BDS-SIS-ICD-B1I 5.2.4.
/// @param t  of transmission, GPS time. The time group delay of the user's signal is not taken off.
[[nodiscard]] SatelliteState satellite_state(const record::KeplerEphemeris& ephemeris, geo::GpsTime t);
/// GLONASS: ICD 5.1 annex A.3.1.2, Runge-Kutta of fourth order over at most 60 s a step; SBAS: RTCA DO-229 A.4.4.11.
[[nodiscard]] SatelliteState satellite_state(const record::TabulatedEphemeris& ephemeris, geo::GpsTime t);

/// Where the satellites of a mission are, by whatever tells it.
class Orbits {
 public:
  virtual ~Orbits() = default;
  /// @param t  of transmission, GPS time; none where nothing is known of the satellite then
  [[nodiscard]] virtual std::optional<SatelliteState> at(record::Satellite satellite, geo::GpsTime t) const = 0;
};

/// The broadcast ephemerides of a mission. Unhealthy satellites have none. An ephemeris that puts its satellite elsewhere (100
/// km) than the one before and the one after it, which agree with each other, was filed under a wrong number or is damaged: it
/// is left out, with an event.
class BroadcastOrbits : public Orbits {
 public:
  explicit BroadcastOrbits(const record::NavigationRecording& navigation);

  /// By the ephemeris nearest in time that is valid (2 h of GPS and QZSS, 15 min of GLONASS, 6 min of SBAS; Galileo 4 h and
  /// BeiDou 1 h behind the reference, a quarter of that before it); of Galileo I/NAV where both are there.
  [[nodiscard]] std::optional<SatelliteState> at(record::Satellite satellite, geo::GpsTime t) const override;
  /// The ephemeris that `at` would use, of the Keplerian ones: for group delays, accuracy and issue.
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
/// clocks linearly between those of the clock files or, without, of the orbit files; relativity's periodic part is added
/// (IS-GPS-200 20.3.3.3.3.1). Positions are of the centre of mass: phase centres (PhaseCentredOrbits) lie up to 3 m closer to
/// the Earth, a millimetre over 10 km.
class PreciseEphemerides : public Orbits {
 public:
  /// @param clocks  may be empty
  PreciseEphemerides(record::PreciseOrbits orbits, record::PreciseClocks clocks);
  /// None before the first and behind the last point, beside gaps, and without a clock.
  [[nodiscard]] std::optional<SatelliteState> at(record::Satellite satellite, geo::GpsTime t) const override;

 private:
  record::PreciseOrbits orbits_;
  record::PreciseClocks clocks_;
};

/// Axes of a satellite that steers its yaw, as columns, in ECEF: z to the geocentre, y along its panels, z x Sun, x to the side
/// of the Sun (Montenbruck et al. 2015, the IGS convention); without the turns at noon, midnight and in shadow.
[[nodiscard]] Eigen::Matrix3d yaw_steering_axes(const Eigen::Vector3d& r_satellite_e, const Eigen::Vector3d& r_sun_e);

/// Orbits of centres of mass carried to the antennas' phase centres by the satellites' calibrations of the time (ANTEX), to the
/// ionosphere-free one of the first two bands, which clocks of the analysis centres refer to. Satellites without stay.
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
