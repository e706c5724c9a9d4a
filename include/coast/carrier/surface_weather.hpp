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
  double vapour_pressure_hpa = 0.0;  ///< partial pressure of water vapour, hPa; contained in `pressure_hpa`
  double vapour_decrease = 3.0;      ///< lambda: upwards the vapour pressure falls as the pressure to the power lambda + 1
};

/// Height of the geoid above the ellipsoid, m, from the spherical harmonics to degree and order 9 of GPT (Boehm, Heinkelmann
/// and Schuh 2007). For pressures (10 m are 1.2 hPa), not for levelling: wrong by 1 m at the poles, by 6 m in the hollow south
/// of India, by more in mountains. The height of the point is not used.
[[nodiscard]] double geoid_undulation(const geo::Geodetic& point);

/// Mean weather of a place and a day of the year, at the height of the point.
///
/// Pressure and temperature are GPT's (Boehm, Heinkelmann and Schuh 2007, J. Geodesy 81, 679-683; IERS Conventions 2010,
/// chapter 9): mean and annual amplitude on the geoid in spherical harmonics, extreme on 28 January and half a year later,
/// brought to the height H above that geoid with
///
///     P = P0 (1 - 2.26e-5 H)^5.225,    T = T0 - 0.0065 H
///
/// Vapour pressure, which GPT lacks, is that of RTCA DO-229 (A.4.2.4; Collins and Langley 1997): a table of five latitudes from
/// 15 to 75 degrees, linear between and constant beyond, with least vapour on 28 January in the north and 183 days later in the
/// south, brought to H in the profile of its own temperature Tt and lapse rate beta,
///
///     e = e0 (1 - beta H / Tt)^((lambda + 1) g / (Rd beta))
///
/// but no more than saturates the air over water (Magnus' formula as in WMO-No. 8, 2008, annex 4.B): the table knows no
/// longitudes, and would put 31 hPa into the cool air off California in July, which holds 18.
///
/// @param point  any place; latitude and longitude in rad, height in m above the ellipsoid. Heights above 10 km or below -500 m
///               are taken as these. Continuous over poles, equator and date line.
/// @param t      any time; a year is 365.25 days from 1980 on, without a step at New Year
/// @note  A climate, no weather: the pressure of a day departs by 10 hPa and more; 1 hPa is 2.3 mm of delay. No daily term.
[[nodiscard]] SurfaceWeather surface_weather(const geo::Geodetic& point, geo::GpsTime t);

/// Delay at the zenith, m, of air known at the antenna:
///
///     hydrostatic = 0.0022768 P / f,  f = 1 - 0.00266 cos 2 latitude - 2.8e-7 h      Saastamoinen (1972), Davis et al. (1985)
///     wet         = 1e-6 (k2' + k3 / Tm) Rd e / (gm (lambda + 1))                     Askne and Nordius (1987)
///
/// with gm = 9.784 f m/s^2, the mean temperature of the vapour Tm = T (1 - 0.0065 Rd / (gm (lambda + 1))), and k2' = 16.52
/// K/hPa, k3 = 377600 K^2/hPa (Thayer 1974). The wet part is exact in air with such a profile; it agrees with that of DO-229
/// within 4 % over its table, and for lambda = 3 with Saastamoinen's 0.002277 (1255 / T + 0.05) e within 3 %.
/// @param point  of the antenna: latitude in rad, height h in m above the ellipsoid, limited as above
[[nodiscard]] ZenithDelay zenith_delay(const SurfaceWeather& weather, const geo::Geodetic& point);

}  // namespace coast::carrier
