#include "coast/carrier/surface_weather.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

#include "coast/geo/units.hpp"

namespace coast::carrier {
namespace {

constexpr double kDay = 86400.0;

// 28 January 1980, where both models begin to count.
geo::GpsTime coldest() {
  return geo::GpsTime::from_calendar({1980, 1, 28, 0, 0, 0.0});
}

/// A point at a height above the geoid, from degrees and m.
geo::Geodetic above_geoid(double latitude, double longitude, double height) {
  geo::Geodetic point{latitude * geo::kDegree, longitude * geo::kDegree, 0.0};
  point.height = height + geoid_undulation(point);
  return point;
}

void expect_same(const SurfaceWeather& a, const SurfaceWeather& b, double tolerance) {
  EXPECT_NEAR(a.pressure_hpa, b.pressure_hpa, tolerance);
  EXPECT_NEAR(a.temperature_k, b.temperature_k, tolerance);
  EXPECT_NEAR(a.vapour_pressure_hpa, b.vapour_pressure_hpa, tolerance);
  EXPECT_NEAR(a.vapour_decrease, b.vapour_decrease, tolerance);
}

// IERS Conventions (2010), test case of GPT.F (Green Bank, MJD 55055). It holds every digit of the tables: one unit in the last
// place of any coefficient moves the result by more than 9e-10.
TEST(SurfaceWeather, GptOfTheConventions) {
  const geo::Geodetic at{0.6708665767, -1.393397187, 812.546};
  const SurfaceWeather weather = surface_weather(at, geo::GpsTime::from_calendar({2009, 8, 12, 0, 0, 0.0}));
  EXPECT_NEAR(weather.pressure_hpa, 918.0710638757364, 1e-10);
  EXPECT_NEAR(weather.temperature_k, 273.15 + 19.31914181012883, 1e-10);
  EXPECT_NEAR(geoid_undulation(at), -42.19185643717771, 1e-10);
}

// EGM96 has 13.6 m and -29.5 m at the poles and -106 m in the hollow south of India.
TEST(SurfaceWeather, UndulationIsNearTheGeoid) {
  EXPECT_NEAR(geoid_undulation({90.0 * geo::kDegree, 1.0, 0.0}), 13.6, 1.1);
  EXPECT_NEAR(geoid_undulation({-90.0 * geo::kDegree, 1.0, 0.0}), -29.5, 1.1);
  EXPECT_NEAR(geoid_undulation({4.7 * geo::kDegree, 78.8 * geo::kDegree, 0.0}), -106.0, 6.5);
}

// The annual term: opposite after half a year, extreme on 28 January, the same 1461 days (4 years of both models) later.
TEST(SurfaceWeather, SeasonsOfGpt) {
  const geo::Geodetic yakutsk = above_geoid(62.0, 130.0, 100.0);
  const double half_year = 182.625 * kDay;
  const SurfaceWeather january = surface_weather(yakutsk, coldest());
  const SurfaceWeather july = surface_weather(yakutsk, coldest() + half_year);
  EXPECT_GT(july.temperature_k, january.temperature_k + 40.0);
  for (const double day : {1.0, 20.0, 100.0, 300.0}) {
    const SurfaceWeather now = surface_weather(yakutsk, coldest() + day * kDay);
    const SurfaceWeather then = surface_weather(yakutsk, coldest() + day * kDay + half_year);
    EXPECT_NEAR(now.temperature_k + then.temperature_k, january.temperature_k + july.temperature_k, 1e-9);
    EXPECT_NEAR(now.pressure_hpa + then.pressure_hpa, january.pressure_hpa + july.pressure_hpa, 1e-9);
    EXPECT_GT(now.temperature_k, january.temperature_k);
    EXPECT_LT(now.temperature_k, july.temperature_k);
    expect_same(now, surface_weather(yakutsk, coldest() + (1461.0 * 10.0 + day) * kDay), 1e-9);
  }
  const geo::Geodetic brisbane = above_geoid(-27.5, 153.0, 0.0);
  EXPECT_GT(surface_weather(brisbane, coldest()).temperature_k,
            surface_weather(brisbane, coldest() + half_year).temperature_k + 8.0);
}

// RTCA DO-229, A.4.2.4: average and amplitude of the vapour pressure and of lambda, on 10 degrees east, where the air can hold
// them all the year.
TEST(SurfaceWeather, VapourOfTheTable) {
  const double latitude[] = {15.0, 30.0, 45.0, 60.0, 75.0};
  const double average[] = {26.31, 21.79, 11.66, 6.78, 4.11};
  const double amplitude[] = {0.0, 8.85, 7.24, 5.36, 3.39};
  const double decrease[] = {2.77, 3.15, 2.57, 1.81, 1.55};
  const double decrease_amplitude[] = {0.0, 0.33, 0.46, 0.74, 0.30};
  const double kelvin[] = {299.65, 294.15, 283.15, 272.15, 263.65};
  const double kelvin_amplitude[] = {0.0, 7.0, 11.0, 15.0, 14.5};
  const double lapse[] = {6.30e-3, 6.05e-3, 5.58e-3, 5.39e-3, 4.53e-3};
  const double lapse_amplitude[] = {0.0, 0.25e-3, 0.32e-3, 0.81e-3, 0.62e-3};
  for (std::size_t i = 0; i < 5; ++i) {
    for (const int quarter : {0, 1, 2, 3}) {
      const double cosine = quarter == 0 ? 1.0 : quarter == 2 ? -1.0 : 0.0;
      const geo::GpsTime t = coldest() + quarter * 365.25 / 4.0 * kDay;
      const double e = average[i] - cosine * amplitude[i], lambda = decrease[i] - cosine * decrease_amplitude[i];
      const double beta = lapse[i] - cosine * lapse_amplitude[i], base = kelvin[i] - cosine * kelvin_amplitude[i];
      EXPECT_NEAR(surface_weather(above_geoid(latitude[i], 10.0, 0.0), t).vapour_pressure_hpa, e, 1e-9) << latitude[i];
      EXPECT_NEAR(surface_weather(above_geoid(latitude[i], 10.0, 0.0), t).vapour_decrease, lambda, 1e-9) << latitude[i];
      EXPECT_NEAR(surface_weather(above_geoid(latitude[i], 10.0, 300.0), t).vapour_pressure_hpa,
                  e * std::pow((base - 300.0 * beta) / base, (lambda + 1.0) * 9.80665 / (287.054 * beta)), 1e-9)
          << latitude[i];
    }
  }
  // Linear between, constant beyond.
  EXPECT_NEAR(surface_weather(above_geoid(50.0, 10.0, 0.0), coldest() + 365.25 / 4.0 * kDay).vapour_pressure_hpa,
              (2.0 * 11.66 + 6.78) / 3.0, 1e-9);
  EXPECT_NEAR(surface_weather(above_geoid(2.0, 10.0, 0.0), coldest()).vapour_pressure_hpa, 26.31, 1e-9);
  EXPECT_NEAR(surface_weather(above_geoid(80.0, 10.0, 0.0), coldest()).vapour_decrease, 1.55 - 0.30, 1e-9);
  // Height: 45 degrees in the mean of the year, 255.25 K at 5000 m in its own profile.
  EXPECT_NEAR(surface_weather(above_geoid(45.0, 10.0, 5000.0), coldest() + 365.25 / 4.0 * kDay).vapour_pressure_hpa,
              11.66 * std::pow(255.25 / 283.15, 3.57 * 9.80665 / (287.054 * 5.58e-3)), 1e-9);
}

TEST(SurfaceWeather, SouthIsHalfAYearAway) {
  for (const double day : {0.0, 40.0, 200.0}) {
    const SurfaceWeather north = surface_weather(above_geoid(30.0, 140.0, 0.0), coldest() + day * kDay);
    const SurfaceWeather south = surface_weather(above_geoid(-30.0, 140.0, 0.0), coldest() + (day + 183.0) * kDay);
    EXPECT_NEAR(north.vapour_pressure_hpa, south.vapour_pressure_hpa, 1e-9);
    EXPECT_NEAR(north.vapour_decrease, south.vapour_decrease, 1e-9);
  }
}

// July off California: 30.64 hPa of the table in air of 16 degrees. Magnus' formula and that of Goff and Gratch (1946) agree
// within 0.3 % there and within 1 % from -80 to 30 degrees.
TEST(SurfaceWeather, AirHoldsItsVapour) {
  const auto goff_gratch = [](double kelvin) {
    const double x = 373.16 / kelvin;
    return 1013.246 * std::pow(10.0, -7.90298 * (x - 1.0) + 5.02808 * std::log10(x) -
                                         1.3816e-7 * (std::pow(10.0, 11.344 * (1.0 - 1.0 / x)) - 1.0) +
                                         8.1328e-3 * (std::pow(10.0, -3.49149 * (x - 1.0)) - 1.0));
  };
  const SurfaceWeather july = surface_weather(above_geoid(30.0, -132.0, 0.0), coldest() + 182.625 * kDay);
  EXPECT_NEAR(july.vapour_pressure_hpa, 18.0, 0.5);
  EXPECT_NEAR(july.vapour_pressure_hpa / goff_gratch(july.temperature_k), 1.0, 0.003);
  for (int latitude = -90; latitude <= 90; latitude += 10) {
    for (int longitude = -180; longitude < 180; longitude += 30) {
      for (const double height : {-100.0, 0.0, 1000.0, 5000.0}) {
        const SurfaceWeather weather = surface_weather(above_geoid(latitude, longitude, height), coldest());
        EXPECT_GT(weather.vapour_pressure_hpa, 0.0);
        EXPECT_LT(weather.vapour_pressure_hpa, 1.01 * goff_gratch(weather.temperature_k));
      }
    }
  }
}

TEST(SurfaceWeather, IsContinuous) {
  const geo::GpsTime t = coldest() + 50.0 * kDay;
  const double pi = std::numbers::pi;
  const double step = 1e-9;  // rad, 6 mm
  for (const double latitude : {-1.2, -0.3, 0.4, 1.4})
    expect_same(surface_weather({latitude, pi, 300.0}, t), surface_weather({latitude, -pi + step, 300.0}, t), 1e-6);
  for (const double longitude : {-3.0, 0.0, 2.0}) {
    expect_same(surface_weather({-step, longitude, 300.0}, t), surface_weather({step, longitude, 300.0}, t), 1e-6);
    for (const double pole : {-pi / 2.0, pi / 2.0})
      expect_same(surface_weather({pole, 0.0, 300.0}, t), surface_weather({pole * (1.0 - step), longitude, 300.0}, t), 1e-6);
    for (const double edge : {15.0, 30.0, 45.0, 60.0, 75.0})
      expect_same(surface_weather({-edge * geo::kDegree - step, longitude, 300.0}, t),
                  surface_weather({-edge * geo::kDegree + step, longitude, 300.0}, t), 1e-6);
  }
  const geo::GpsTime new_year = geo::GpsTime::from_calendar({2024, 1, 1, 0, 0, 0.0});
  expect_same(surface_weather({0.8, 0.1, 0.0}, new_year - 1.0), surface_weather({0.8, 0.1, 0.0}, new_year), 1e-5);
}

TEST(SurfaceWeather, FallsWithHeightAndStaysFinite) {
  const geo::GpsTime t = coldest() + 100.0 * kDay;
  const auto at = [&](double height) { return surface_weather({46.5 * geo::kDegree, 6.5 * geo::kDegree, height}, t); };
  for (double height = -100.0; height < 9000.0; height += 100.0) {
    const SurfaceWeather low = at(height), high = at(height + 100.0);
    EXPECT_LT(high.pressure_hpa, low.pressure_hpa);
    EXPECT_LT(high.vapour_pressure_hpa, low.vapour_pressure_hpa);
    EXPECT_NEAR(high.temperature_k, low.temperature_k - 0.65, 1e-9);
    EXPECT_GT(high.pressure_hpa, 300.0);
  }
  expect_same(at(1e9), at(10000.0), 0.0);
  expect_same(at(-1e9), at(-500.0), 0.0);
  expect_same(at(std::numeric_limits<double>::infinity()), at(10000.0), 0.0);
  for (const double height : {-1e9, 1e9, std::numeric_limits<double>::infinity()}) {
    const ZenithDelay delay = zenith_delay(at(height), {46.5 * geo::kDegree, 6.5 * geo::kDegree, height});
    EXPECT_GT(delay.hydrostatic, 0.6);
    EXPECT_LT(delay.hydrostatic, 2.5);
    EXPECT_GT(delay.wet, 0.0);
    EXPECT_LT(delay.wet, 0.5);
  }
  for (const geo::GpsTime extreme : {geo::GpsTime::from_nanoseconds(std::numeric_limits<std::int64_t>::min()),
                                     geo::GpsTime::from_nanoseconds(std::numeric_limits<std::int64_t>::max())})
    EXPECT_NEAR(surface_weather({0.8, 0.1, 0.0}, extreme).pressure_hpa, 1015.0, 15.0);
}

TEST(ZenithDelay, Hydrostatic) {
  EXPECT_NEAR(zenith_delay({1013.25, 288.0, 0.0}, {45.0 * geo::kDegree, 0.0, 0.0}).hydrostatic, 2.30697, 1e-5);
  EXPECT_NEAR(zenith_delay({1013.25, 288.0, 0.0}, {0.0, 0.0, 0.0}).hydrostatic, 2.30697 / 0.99734, 1e-5);
  EXPECT_NEAR(zenith_delay({700.0, 288.0, 0.0}, {90.0 * geo::kDegree, 0.0, 3000.0}).hydrostatic, 1.59376 / (1.00266 - 0.00084),
              1e-5);
  EXPECT_NEAR(zenith_delay({1.0, 288.0, 0.0}, {45.0 * geo::kDegree, 0.0, 0.0}).hydrostatic, 2.3e-3, 0.03e-3);
}

// Refractivity of the vapour summed up to 40 km in air that cools by 6.5 K/km and whose vapour pressure is a power of the
// temperature; at 45 degrees, where gravity is 9.784 m/s^2. Steps of 10 m by Simpson's rule: far better than 1e-7 m.
TEST(ZenithDelay, WetIsTheIntegralOfItsAir) {
  for (const double decrease : {1.25, 2.0, 3.0}) {
    const SurfaceWeather air{1013.25, 290.0, 12.0, decrease};
    const double power = (decrease + 1.0) * 9.784 / (287.054 * 0.0065);
    const auto refractivity = [&](double z) {
      const double kelvin = 290.0 - 0.0065 * z;
      return 1e-6 * (16.52 + 377600.0 / kelvin) * 12.0 * std::pow(kelvin / 290.0, power) / kelvin;
    };
    double sum = 0.0;
    for (double z = 0.0; z < 39995.0; z += 10.0)
      sum += (refractivity(z) + 4.0 * refractivity(z + 5.0) + refractivity(z + 10.0)) * 10.0 / 6.0;
    EXPECT_NEAR(zenith_delay(air, {45.0 * geo::kDegree, 0.0, 0.0}).wet, sum, 1e-6) << decrease;
  }
}

// DO-229's own delay, 382000e-6 Rd e / (T (9.784 (lambda + 1) - beta Rd)), over its table from least to most vapour; and
// Saastamoinen's.
TEST(ZenithDelay, WetAgreesWithOtherFormulas) {
  const double table[5][4] = {{26.31, 299.65, 6.30e-3, 2.77},
                              {21.79, 294.15, 6.05e-3, 3.15},
                              {11.66, 283.15, 5.58e-3, 2.57},
                              {6.78, 272.15, 5.39e-3, 1.81},
                              {4.11, 263.65, 4.53e-3, 1.55}};
  const double amplitude[5][4] = {{0.0, 0.0, 0.0, 0.0},
                                  {8.85, 7.0, 0.25e-3, 0.33},
                                  {7.24, 11.0, 0.32e-3, 0.46},
                                  {5.36, 15.0, 0.81e-3, 0.74},
                                  {3.39, 14.5, 0.62e-3, 0.30}};
  const geo::Geodetic at{45.0 * geo::kDegree, 0.0, 0.0};
  for (std::size_t i = 0; i < 5; ++i) {
    for (const double season : {-1.0, 0.0, 1.0}) {
      const auto value = [&](std::size_t column) { return table[i][column] - season * amplitude[i][column]; };
      const double e = value(0), kelvin = value(1), lapse = value(2), decrease = value(3);
      const double do229 = 382000e-6 * 287.054 * e / (kelvin * (9.784 * (decrease + 1.0) - lapse * 287.054));
      EXPECT_NEAR(zenith_delay({1000.0, kelvin, e, decrease}, at).wet / do229, 1.0, 0.04);
      EXPECT_NEAR(zenith_delay({1000.0, kelvin, e}, at).wet / (0.002277 * (1255.0 / kelvin + 0.05) * e), 1.0, 0.03);
    }
  }
}

// Against the standard atmosphere up to 3000 m and 50 degrees of latitude, all seasons: within 5 cm hydrostatic; wet within 10
// cm less and 17 cm more, that of the tropics at the sea. Beyond, the low pressure about Antarctica takes up to 16 cm off.
TEST(ZenithDelay, IsNearTheStandardAtmosphere) {
  const auto standard_delay = [](const geo::Geodetic& at) {  // ISO 2533, 70 % of humidity at sea level
    const double pressure = 1013.25 * std::pow(1.0 - 2.2557e-5 * at.height, 5.2568);
    const double kelvin = 288.15 - 6.5e-3 * at.height;
    const double vapour = 6.108 * 0.7 * std::exp((17.15 * kelvin - 4684.0) / (kelvin - 38.45));
    return zenith_delay({pressure, kelvin, vapour}, at);
  };
  for (int latitude = -90; latitude <= 90; latitude += 5) {
    for (int longitude = -180; longitude < 180; longitude += 15) {
      for (const double height : {0.0, 1000.0, 3000.0}) {
        for (const double day : {0.0, 91.0, 183.0, 274.0}) {
          const geo::Geodetic at{latitude * geo::kDegree, longitude * geo::kDegree, height};
          const ZenithDelay mean = zenith_delay(surface_weather(at, coldest() + day * kDay), at);
          const ZenithDelay standard = standard_delay(at);
          EXPECT_NEAR(mean.hydrostatic, standard.hydrostatic, std::abs(latitude) <= 50 ? 0.05 : 0.16);
          EXPECT_GT(mean.wet - standard.wet, -0.12);
          EXPECT_LT(mean.wet - standard.wet, 0.17);
          if (height == 0.0 && std::abs(latitude) <= 50) {
            EXPECT_NEAR(mean.hydrostatic, 2.3, 0.05);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace coast::carrier
