#pragma once
// Ionospheric and tropospheric delays of a signal.

#include <array>

#include "coast/geo/earth.hpp"
#include "coast/geo/time.hpp"
#include "coast/record/navigation.hpp"

namespace coast::carrier {

/// Direction to a satellite as seen from a receiver.
struct Direction {
  double azimuth = 0.0;    ///< rad, from north over east, [0, 2 pi)
  double elevation = 0.0;  ///< rad, [-pi/2, pi/2]
};
[[nodiscard]] Direction direction_of(const Eigen::Vector3d& r_satellite_e, const Eigen::Vector3d& r_receiver_e);

/// Ionospheric delay of a code on L1 (1575.42 MHz), m; a phase is advanced by the same amount; other frequencies f: times
/// (f1/f)^2 (Klobuchar 1987; IS-GPS-200 20.3.3.5.2.5). The model removes only about half of the delay.
[[nodiscard]] double klobuchar_delay(const record::Klobuchar& model, const geo::Geodetic& receiver, const Direction& direction,
                                     geo::GpsTime t);

/// Zenith delay, m; computed in surface_weather.hpp.
struct ZenithDelay {
  double hydrostatic = 0.0;
  double wet = 0.0;
};

/// Mapping functions: slant delay over zenith delay (Niell 1996), down to 3 degrees of elevation.
struct TroposphericMapping {
  double hydrostatic = 1.0;
  double wet = 1.0;
};
/// @throws std::invalid_argument  an elevation below 1 degree
[[nodiscard]] TroposphericMapping niell_mapping(const geo::Geodetic& receiver, double elevation, geo::GpsTime t);

}  // namespace coast::carrier
