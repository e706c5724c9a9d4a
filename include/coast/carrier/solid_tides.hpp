#pragma once
// How far Sun and Moon lift the ground that an antenna stands on, and where they are.

#include <Eigen/Core>

#include "coast/geo/time.hpp"

namespace coast::carrier {

/// Centre of the Sun, ECEF, m: Meeus (1998, 2nd ed.) chapter 25, low accuracy, rotated from the mean equinox of date by GMST
/// with UT1 taken as UTC (below 0.9 s). Geometric: neither light time nor aberration, 20 arc seconds together; no nutation,
/// no polar motion. Good to 1 arc minute and 1e-4 of the distance from 1980 to 2060.
[[nodiscard]] Eigen::Vector3d sun_e(geo::GpsTime t);

/// Centre of the Moon, ECEF, m: the series of Montenbruck & Gill (2000) section 3.3.2, of date, rotated as the Sun is. Good to
/// 5 arc minutes and 500 km.
[[nodiscard]] Eigen::Vector3d moon_e(geo::GpsTime t);

/// Displacement of a point of the solid Earth by Sun and Moon, ECEF, m: where the point is at t less its coordinates.
///
/// IERS Conventions (2010) 7.1.1, step 1: degree 2 with Love and Shida numbers that depend on latitude (7.5), degree 3 (7.6),
/// l(1) of the diurnal and semidiurnal band (7.8, 7.9), what is out of phase in these (7.10, 7.11). Of step 2 only the radial
/// in-phase part of the four largest diurnal tides, K1 (12 mm) first (table 7.3a). Left out are the rest of step 2, up to
/// 3 mm, and all that is not the body tide: ocean loading, pole tide, atmosphere.
///
/// The system is conventional tide free, as that of ITRF coordinates: the displacement contains the permanent one, which is NOT
/// restored (step 3 of the Conventions). Add it to coordinates of ITRF to get where the point is.
///
/// @param r_e  point near the surface, ECEF, m, not the geocentre; to 1 km it does not matter where
/// @return     up to 0.4 m; within 3 mm of the complete model of the Conventions, 1 mm as a rule. Smooth in t and, but for the
///             direction of east, which no term keeps at a pole, in r_e
[[nodiscard]] Eigen::Vector3d solid_tide(const Eigen::Vector3d& r_e, geo::GpsTime t);

}  // namespace coast::carrier
