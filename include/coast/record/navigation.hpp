#pragma once
// Broadcast ephemerides of GNSS satellites.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"
#include "coast/record/satellite.hpp"

namespace coast::record {

/// Clock polynomial and Keplerian orbit of GPS, Galileo, BeiDou and QZSS; angles in rad, lengths in m, times in GPS time.
struct KeplerEphemeris {
  Satellite satellite;
  geo::GpsTime toc;               ///< of the clock polynomial
  geo::GpsTime toe;               ///< of the orbit
  std::array<double, 3> clock{};  ///< s, s/s, s/s^2
  double sqrt_a = 0.0;            ///< sqrt(m)
  double eccentricity = 0.0;
  double mean_anomaly = 0.0;
  double delta_n = 0.0;  ///< rad/s
  double perigee = 0.0;  ///< argument of perigee
  double node = 0.0;     ///< longitude of the ascending node at the start of the week
  double node_rate = 0.0;
  double inclination = 0.0;
  double inclination_rate = 0.0;
  double cuc = 0.0, cus = 0.0;          ///< rad
  double crc = 0.0, crs = 0.0;          ///< m
  double cic = 0.0, cis = 0.0;          ///< rad
  int issue = 0;                        ///< issue of data: IODE, IODnav, AODE
  int sources = 0;                      ///< Galileo: data source bits; others: codes on L2
  double accuracy_m = 0.0;              ///< as stated: URA, SISA
  int health = 0;                       ///< 0: healthy
  std::array<double, 2> group_delay{};  ///< s: TGD; Galileo BGD E5a/E1, E5b/E1; BeiDou TGD1, TGD2
};

/// Position, velocity and acceleration of GLONASS and SBAS in ECEF (PZ-90 as WGS 84).
struct TabulatedEphemeris {
  Satellite satellite;
  geo::GpsTime t;                                 ///< of position and clock
  double clock_bias = 0.0;                        ///< s: -tau_n of GLONASS
  double clock_drift = 0.0;                       ///< gamma_n
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d a_e = Eigen::Vector3d::Zero();  ///< m/s^2: luni-solar only (GLONASS); total (SBAS)
  int channel = 0;                                ///< frequency number of GLONASS
  int health = 0;                                 ///< 0: healthy
  double accuracy_m = 0.0;                        ///< as stated; 0: none stated
};

/// Coefficients of Klobuchar's model of the ionosphere.
struct Klobuchar {
  std::array<double, 4> alpha{};  ///< s, s/semicircle, ...
  std::array<double, 4> beta{};
};

struct NavigationRecording {
  std::string source;
  std::vector<KeplerEphemeris> kepler;        ///< by satellite, then by toe
  std::vector<TabulatedEphemeris> tabulated;  ///< by satellite, then by time
  std::optional<Klobuchar> gps_ionosphere;
  Events events;
};

}  // namespace coast::record
