#pragma once
// The weather that a place has at a season, for the delay of the troposphere where nobody measured it.

#include "coast/carrier/atmosphere.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/time.hpp"

namespace coast::carrier {

/// Air at a point.
struct SurfaceWeather {
  double pressure_hpa = 0.0;         ///< total pressure, hPa
  double temperature_k = 0.0;        ///< K
  double vapour_pressure_hpa = 0.0;  ///< partial pressure of water vapour, hPa; within `pressure_hpa`
};

/// Height of the geoid above the ellipsoid, m, from spherical harmonics to degree and order 9, those of GPT (Boehm, Heinkelmann
/// and Schuh 2007). It is smooth over 2000 km: good for the pressure (10 m are 1.2 hPa), not for levelling. The height of the
/// point is not used.
[[nodiscard]] double geoid_undulation(const geo::Geodetic& point);

/// Mean weather of a place and a day of the year, at the height of the point.
///
/// Pressure and temperature are GPT's (Boehm, Heinkelmann and Schuh 2007, J. Geodesy 81, 679-683; IERS Conventions 2010, 9.2):
/// mean and annual amplitude on the geoid in spherical harmonics to degree and order 9, coldest and warmest about 28 January,
/// brought to the height H above that geoid with
///
///     P = P0 (1 - 2.26e-5 H)^5.225,    T = T0 - 0.0065 H
///
/// Vapour pressure, which GPT lacks, is that of RTCA DO-229D (A.4.2.4; Collins and Langley 1997): five latitudes from 15 to 75
/// degrees with an annual term, linear between them, constant beyond, 28 January in the north and 30 July (day 211) in the
/// south, with the height H in its own profile of temperature Tm and lapse rate beta
///
///     e = e0 (1 - beta H / Tm)^((lambda + 1) g / (Rd beta))
///
/// and no more than saturates the air (over water, Magnus' formula as in WMO-No. 8, 2008, annex 4.B): a mean over all
/// longitudes gives a Siberian January seven times the vapour that its air can hold, 15 mm of delay.
///
/// @param point  any place; latitude and longitude in rad, height in m above the ellipsoid. Heights above 10 km or below -500 m
///               are taken as these. Continuous everywhere, over poles, equator and date line too.
/// @param t      any time. Both models count a year of 365.25 days, here from 1980 on without a step at New Year.
/// @note  A climate, not a weather: the pressure of a day is 10 hPa off in mid-latitudes (23 mm of delay), no tide of the day.
[[nodiscard]] SurfaceWeather surface_weather(const geo::Geodetic& point, geo::GpsTime t);

/// Delay at the zenith of air known at the antenna, as `standard_zenith_delay` has it:
///
///     hydrostatic = 0.0022768 P / (1 - 0.00266 cos 2 latitude - 2.8e-7 h)     Davis et al. (1985), IERS Conventions (9.4)
///     wet         = 0.002277 (1255 / T + 0.05) e                              Saastamoinen (1972)
///
/// in m, for hPa, K and m. The wet formula supposes a mean decrease of vapour with height; DO-229's own, from the same vapour
/// pressures, gives 8 to 16 % more.
/// @param point  of the antenna: latitude in rad, height h in m above the ellipsoid, from -500 m to 10 km as above
[[nodiscard]] ZenithDelay zenith_delay(const SurfaceWeather& weather, const geo::Geodetic& point);

}  // namespace coast::carrier
