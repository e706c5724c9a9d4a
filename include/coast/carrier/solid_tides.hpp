#pragma once
// Solid Earth tide displacement of an antenna, and positions of Sun and Moon.

#include <Eigen/Core>

#include "coast/geo/time.hpp"

namespace coast::carrier {

/// Centre of the Sun, ECEF, m: Meeus (1998, 2nd ed.) chapter 25, low accuracy, rotated from the mean equinox of date by GMST
/// with UT1 = UTC (error 0.9 s at most). Geometric: neither light time nor aberration (20 arc seconds), no nutation, no polar
/// motion. Within 1.2 arc minutes and 1e-4 of the distance of libastro's apparent places, 1982 to 2057.
[[nodiscard]] Eigen::Vector3d sun_e(geo::GpsTime t);

/// Centre of the Moon, ECEF, m: the series of Montenbruck & Gill (2000) section 3.3.2, of date, rotated like that of the Sun.
/// Within 5 arc minutes and 500 km of libastro in the same years.
[[nodiscard]] Eigen::Vector3d moon_e(geo::GpsTime t);

/// Displacement of a point of the solid Earth by Sun and Moon, ECEF, m: actual position at t minus the coordinates.
///
/// IERS Conventions (2010) 7.1.1. Step 1: degree 2 with Love and Shida numbers that depend on latitude (7.5), degree 3 (7.6),
/// l(1) of the diurnal and semidiurnal band (7.8, 7.9), their out-of-phase parts (7.10, 7.11). Step 2: the diurnal and zonal
/// tides whose Love numbers change the result by 0.05 mm or more (7.12, 7.13), the largest K1 with 12 mm. Only the body tide is
/// included, not ocean loading, pole tide or atmospheric loading.
///
/// The system is conventional tide free, like ITRF coordinates: the displacement contains the permanent tide, which is NOT
/// restored (step 3 of the Conventions). Add it to ITRF coordinates to get the actual position.
///
/// @param r_e  point near the surface, ECEF, m; not the geocentre
/// @return     up to 0.4 m. With exact Sun and Moon within 0.1 mm of the Conventions' program DEHANTTIDEINEL; sun_e and moon_e
///             add 0.15 mm (rms), 1 mm at most
[[nodiscard]] Eigen::Vector3d solid_tide(const Eigen::Vector3d& r_e, geo::GpsTime t);
/// The same with given positions of Sun and Moon, ECEF, m.
[[nodiscard]] Eigen::Vector3d solid_tide(const Eigen::Vector3d& r_e, geo::GpsTime t, const Eigen::Vector3d& r_sun_e,
                                         const Eigen::Vector3d& r_moon_e);

}  // namespace coast::carrier
