#pragma once
// Mean weather by place and season, for the tropospheric delay when no weather was measured.

#include "coast/carrier/atmosphere.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/time.hpp"

namespace coast::carrier {

/// Air at a point.
struct SurfaceWeather {
  double pressure_hpa = 0.0;         ///< total pressure, hPa
  double temperature_k = 0.0;        ///< K
  double vapour_pressure_hpa = 0.0;  ///< partial pressure of water vapour, hPa; contained in `pressure_hpa`
  double vapour_decrease = 3.0;  ///< lambda: with height, the vapour pressure decreases as the pressure to the power lambda + 1
};

/// Height of the geoid above the ellipsoid, m, from the spherical harmonics to degree and order 9 of GPT (Boehm, Heinkelmann
/// and Schuh 2007). For pressures (10 m are 1.2 hPa), not for levelling: errors are 1 m at the poles, 6 m in the geoid low
/// south of India, more in mountains. The height of the point is not used.
[[nodiscard]] double geoid_undulation(const geo::Geodetic& point);

/// Mean weather of a place and a day of the year, at the height of the point.
///
/// Pressure and temperature are GPT's (Boehm, Heinkelmann and Schuh 2007, J. Geodesy 81, 679-683; IERS Conventions 2010,
/// chapter 9): mean and annual amplitude on the geoid in spherical harmonics, extreme on 28 January and half a year later,
/// reduced to the height H above that geoid with
///
///     P = P0 (1 - 2.26e-5 H)^5.225,    T = T0 - 0.0065 H
///
/// Vapour pressure, not included in GPT, is that of RTCA DO-229 (A.4.2.4; Collins and Langley 1997): a table of five latitudes
/// from 15 to 75 degrees, linear between and constant beyond, with the minimum on 28 January in the north and 183 days later in
/// the south, reduced to H with the temperature Tt and lapse rate beta of that model,
///
///     e = e0 (1 - beta H / Tt)^((lambda + 1) g / (Rd beta))
///
/// limited to saturation over water (Magnus' formula as in WMO-No. 8, 2008, annex 4.B): the table does not depend on longitude,
/// and gives 31 hPa in the cool air off California in July, where saturation is 18 hPa.
///
/// @param point  any place; latitude and longitude in rad, height in m above the ellipsoid. Heights are limited to -500 m to 10
///               km. Continuous over poles, equator and date line.
/// @param t      any time; a year is 365.25 days counted from 1980, without a step at New Year
/// @note  Climate, not weather: the actual pressure differs by 10 hPa and more; 1 hPa is 2.3 mm of delay. No daily term.
[[nodiscard]] SurfaceWeather surface_weather(const geo::Geodetic& point, geo::GpsTime t);

/// Zenith delay, m, from the weather at the antenna:
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
