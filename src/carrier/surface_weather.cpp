#include "coast/carrier/surface_weather.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

#include "latitude_table.hpp"

namespace coast::carrier {

namespace {

constexpr double kYear = 365.25;      // d, in both models
constexpr double kFreezing = 273.15;  // K

/// The coefficients of GPT as published: unnormalised harmonics n = 0 to 9, m = 0 to n, of cos m longitude and sin m longitude.
constexpr std::size_t kDegrees = 10;
constexpr std::size_t kTerms = kDegrees * (kDegrees + 1) / 2;
using Terms = std::array<double, kTerms>;
struct Field {
  Terms cosine, sine;
};

// Geoid, m.
constexpr Field kUndulation{
    {-5.6195e-1, -6.0794e-2, -2.0125e-1, -6.4180e-2, -3.6997e-2, 1.0098e+1,  1.6436e+1,  1.4065e+1, 1.9881e+0,  6.4414e-1,
     -4.7482e+0, -3.2290e+0, 5.0652e-1,  3.8279e-1,  -2.6646e-2, 1.7224e+0,  -2.7970e-1, 6.8177e-1, -9.6658e-2, -1.5113e-2,
     2.9206e-3,  -3.4621e+0, -3.8198e-1, 3.2306e-2,  6.9915e-3,  -2.3068e-3, -1.3548e-3, 4.7324e-6, 2.3527e+0,  1.2985e+0,
     2.1232e-1,  2.2571e-2,  -3.7855e-3, 2.9449e-5,  -1.6265e-4, 1.1711e-7,  1.6732e+0,  1.9858e-1, 2.3975e-2,  -9.0013e-4,
     -2.2475e-3, -3.3095e-5, -1.2040e-5, 2.2010e-6,  -1.0083e-6, 8.6297e-1,  5.8231e-1,  2.0545e-2, -7.8110e-3, -1.4085e-4,
     -8.8459e-6, 5.7256e-6,  -1.5068e-6, 4.0095e-7,  -2.4185e-8},
    {0.0,        0.0,        -6.5993e-2, 0.0,        6.5364e-2, -5.8320e+0, 0.0,        1.6961e+0,  -1.3557e+0, 1.2694e+0,
     0.0,        -2.9310e+0, 9.4805e-1,  -7.6243e-2, 4.1076e-2, 0.0,        -5.1808e-1, -3.4583e-1, -4.3632e-2, 2.2101e-3,
     -1.0663e-2, 0.0,        1.0927e-1,  -2.9463e-1, 1.4371e-3, -1.1452e-2, -2.8156e-3, -3.5330e-4, 0.0,        4.4049e-1,
     5.5653e-2,  -2.0396e-2, -1.7312e-3, 3.5805e-5,  7.2682e-5, 2.2535e-6,  0.0,        1.9502e-2,  2.7919e-2,  -8.1812e-3,
     4.4540e-4,  8.8663e-5,  5.5596e-5,  2.4826e-6,  1.0279e-6, 0.0,        6.0529e-2,  -3.5824e-2, -5.1367e-3, 3.0119e-5,
     -2.9911e-5, 1.9844e-5,  -1.2349e-6, -7.6756e-9, 5.0100e-8}};

// Pressure on the geoid, hPa: mean, and annual amplitude.
constexpr Field kPressure{
    {1.0108e+3,  8.4886e+0,  1.4799e+0,  -1.3897e+1, 3.7516e-3,  -1.4936e-1, 1.2232e+1,  -7.6615e-1, -6.7699e-2, 8.1002e-3,
     -1.5874e+1, 3.6614e-1,  -6.7807e-2, -3.6309e-3, 5.9966e-4,  4.8163e+0,  -3.7363e-1, -7.2071e-2, 1.9998e-3,  -6.2385e-4,
     -3.7916e-4, 4.7609e+0,  -3.9534e-1, 8.6667e-3,  1.1569e-2,  1.1441e-3,  -1.4193e-4, -8.5723e-5, 6.5008e-1,  -5.0889e-1,
     -1.5754e-2, -2.8305e-3, 5.7458e-4,  3.2577e-5,  -9.6052e-6, -2.7974e-6, 1.3530e+0,  -2.7271e-1, -3.0276e-4, 3.6286e-3,
     -2.0398e-4, 1.5846e-5,  -7.7787e-6, 1.1210e-6,  9.9020e-8,  5.5046e-1,  -2.7312e-1, 3.2532e-3,  -2.4277e-3, 1.1596e-4,
     2.6421e-7,  -1.3263e-6, 2.7322e-7,  1.4058e-7,  4.9414e-9},
    {0.0,        0.0,       -1.2878e+0, 0.0,        7.0444e-1,  3.3222e-1,  0.0,        -2.9636e-1, 7.2248e-3,  7.9655e-3,
     0.0,        1.0854e+0, 1.1145e-2,  -3.6513e-2, 3.1527e-3,  0.0,        -4.8434e-1, 5.2023e-2,  -1.3091e-2, 1.8515e-3,
     1.5422e-4,  0.0,       6.8298e-1,  2.5261e-3,  -9.9703e-4, -1.0829e-3, 1.7688e-4,  -3.1418e-5, 0.0,        -3.7018e-1,
     4.3234e-2,  7.2559e-3, 3.1516e-4,  2.0024e-5,  -8.0581e-6, -2.3653e-6, 0.0,        1.0298e-1,  -1.5086e-2, 5.6186e-3,
     3.2613e-5,  4.0567e-5, -1.3925e-6, -3.6219e-7, -2.0176e-8, 0.0,        -1.8364e-1, 1.8508e-2,  7.5016e-4,  -9.6139e-5,
     -3.1995e-6, 1.3868e-7, -1.9486e-7, 3.0165e-10, -6.4376e-10}};
constexpr Field kPressureAmplitude{
    {-1.0444e-1, 1.6618e-1,  -6.3974e-2, 1.0922e+0,  5.7472e-1,  -3.0277e-1, -3.5087e+0, 7.1264e-3,  -1.4030e-1, 3.7050e-2,
     4.0208e-1,  -3.0431e-1, -1.3292e-1, 4.6746e-3,  -1.5902e-4, 2.8624e+0,  -3.9315e-1, -6.4371e-2, 1.6444e-2,  -2.3403e-3,
     4.2127e-5,  1.9945e+0,  -6.0907e-1, -3.5386e-2, -1.0910e-3, -1.2799e-4, 4.0970e-5,  2.2131e-5,  -5.3292e-1, -2.9765e-1,
     -3.2877e-2, 1.7691e-3,  5.9692e-5,  3.1725e-5,  2.0741e-5,  -3.7622e-7, 2.6372e+0,  -3.1165e-1, 1.6439e-2,  2.1633e-4,
     1.7485e-4,  2.1587e-5,  6.1064e-6,  -1.3755e-8, -7.8748e-8, -5.9152e-1, -1.7676e-1, 8.1807e-3,  1.0445e-3,  2.3432e-4,
     9.3421e-6,  2.8104e-6,  -1.5788e-7, -3.0648e-8, 2.6421e-10},
    {0.0,        0.0,        9.3340e-1,  0.0,        8.2346e-1,  2.2082e-1,  0.0,        9.6177e-1,  -1.5650e-2, 1.2708e-3,
     0.0,        -3.9913e-1, 2.8020e-2,  2.8334e-2,  8.5980e-4,  0.0,        3.0545e-1,  -2.1691e-2, 6.4067e-4,  -3.6528e-5,
     -1.1166e-4, 0.0,        -7.6974e-2, -1.8986e-2, 5.6896e-3,  -2.4159e-4, -2.3033e-4, -9.6783e-6, 0.0,        -1.0218e-1,
     -1.3916e-2, -4.1025e-3, -5.1340e-5, -7.0114e-5, -3.3152e-7, 1.6901e-6,  0.0,        -1.2422e-2, 2.5072e-3,  1.1205e-3,
     -1.3034e-4, -2.3971e-5, -2.6622e-6, 5.7852e-7,  4.5847e-8,  0.0,        4.4777e-2,  -3.0421e-3, 2.6062e-5,  -7.2421e-5,
     1.9119e-6,  3.9236e-7,  2.2390e-7,  2.9765e-9,  -4.6452e-9}};

// Temperature on the geoid, degrees Celsius: mean, and annual amplitude.
constexpr Field kTemperature{
    {1.6257e+1,  2.1224e+0,  9.2569e-1,  -2.5974e+1, 1.4510e+0,  9.2468e-2,  -5.3192e-1, 2.1094e-1, -6.9210e-2, -3.4060e-2,
     -4.6569e+0, 2.6385e-1,  -3.6093e-2, 1.0198e-2,  -1.8783e-3, 7.4983e-1,  1.1741e-1,  3.9940e-2, 5.1348e-3,  5.9111e-3,
     8.6133e-6,  6.3057e-1,  1.5203e-1,  3.9702e-2,  4.6334e-3,  2.4406e-4,  1.5189e-4,  1.9581e-7, 5.4414e-1,  3.5722e-1,
     5.2763e-2,  4.1147e-3,  -2.7239e-4, -5.9957e-5, 1.6394e-6,  -7.3045e-7, -2.9394e+0, 5.5579e-2, 1.8852e-2,  3.4272e-3,
     -2.3193e-5, -2.9349e-5, 3.6397e-7,  2.0490e-6,  -6.4719e-8, -5.2225e-1, 2.0799e-1,  1.3477e-3, 3.1613e-4,  -2.2285e-4,
     -1.8137e-5, -1.5177e-7, 6.1343e-7,  7.8566e-8,  1.0749e-9},
    {0.0,        0.0,        1.0210e+0,  0.0,        6.0194e-1,  1.2292e-1,  0.0,        -4.2184e-1, 1.8230e-1,  4.2329e-2,
     0.0,        9.3312e-2,  9.5346e-2,  -1.9724e-3, 5.8776e-3,  0.0,        -2.0940e-1, 3.4199e-2,  -5.7672e-3, -2.1590e-3,
     5.6815e-4,  0.0,        2.2858e-1,  1.2283e-2,  -9.3679e-3, -1.4233e-3, -1.5962e-4, 4.0160e-5,  0.0,        3.6353e-2,
     -9.4263e-4, -3.6762e-3, 5.8608e-5,  -2.6391e-5, 3.2095e-6,  -1.1605e-6, 0.0,        1.6306e-1,  1.3293e-2,  -1.1395e-3,
     5.1097e-5,  3.3977e-5,  7.6449e-6,  -1.7602e-7, -7.6558e-8, 0.0,        -4.5415e-2, -1.8027e-2, 3.6561e-4,  -1.1274e-4,
     1.3047e-5,  2.0001e-6,  -1.5152e-7, -2.7807e-8, 7.7491e-9}};
constexpr Field kTemperatureAmplitude{
    {-1.8654e+0, -9.0041e+0, -1.2974e-1, -3.6053e+0, 2.0284e-2,  2.1872e-1,  -1.3015e+0, 4.0355e-1,  2.2216e-1,  -4.0605e-3,
     1.9623e+0,  4.2887e-1,  2.1437e-1,  -1.0061e-2, -1.1368e-3, -6.9235e-2, 5.6758e-1,  1.1917e-1,  -7.0765e-3, 3.0017e-4,
     3.0601e-4,  1.6559e+0,  2.0722e-1,  6.0013e-2,  1.7023e-4,  -9.2424e-4, 1.1269e-5,  -6.9911e-6, -2.0886e+0, -6.7879e-2,
     -8.5922e-4, -1.6087e-3, -4.5549e-5, 3.3178e-5,  -6.1715e-6, -1.4446e-6, -3.7210e-1, 1.5775e-1,  -1.7827e-3, -4.4396e-4,
     2.2844e-4,  -1.1215e-5, -2.1120e-6, -9.6421e-7, -1.4170e-8, 7.8720e-1,  -4.4238e-2, -1.5120e-3, -9.4119e-4, 4.0645e-6,
     -4.9253e-6, -1.8656e-6, -4.0736e-7, -4.9594e-8, 1.6134e-9},
    {0.0,        0.0,        -8.9895e-1, 0.0,        -1.0790e+0, -1.2699e-1, 0.0,       -5.9033e-1, 3.4865e-2,  -3.2614e-2,
     0.0,        -2.4310e-2, 1.5607e-2,  -2.9833e-2, -5.9048e-3, 0.0,        2.8383e-1, 4.0509e-2,  -1.8834e-2, -1.2654e-3,
     -1.3794e-4, 0.0,        1.3306e-1,  3.4960e-2,  -3.6799e-3, -3.5626e-4, 1.4814e-4, 3.7932e-6,  0.0,        2.0801e-1,
     6.5640e-3,  -3.4893e-3, -2.7395e-4, 7.4296e-5,  -7.9927e-6, -1.0277e-6, 0.0,       3.6515e-2,  -7.4319e-3, -6.2873e-4,
     -8.2461e-5, 3.1095e-5,  -5.3860e-7, -1.2055e-7, -1.1517e-7, 0.0,        3.1404e-2, 1.5580e-2,  -1.1428e-3, 3.3529e-5,
     1.0387e-5,  -1.9378e-6, -2.7327e-7, 7.5833e-9,  -9.2323e-9}};

/// P_nm(sin latitude) exp(i m longitude), unnormalised and without the Condon-Shortley phase. The recursion uses the
/// components of the unit vector, so that there is no division by the cosine of the latitude at a pole.
using Harmonics = std::array<std::complex<double>, kTerms>;
Harmonics harmonics(const geo::Geodetic& point) {
  const double axial = std::sin(point.latitude);
  const std::complex<double> equatorial{std::cos(point.latitude) * std::cos(point.longitude),
                                        std::cos(point.latitude) * std::sin(point.longitude)};
  const auto index = [](std::size_t n, std::size_t m) { return n * (n + 1) / 2 + m; };
  Harmonics y;
  y[0] = 1.0;
  for (std::size_t n = 1; n < kDegrees; ++n) {
    const std::complex<double> sectorial = static_cast<double>(2 * n - 1) * y.at(index(n - 1, n - 1));
    for (std::size_t m = 0; m + 2 <= n; ++m)
      y.at(index(n, m)) = (static_cast<double>(2 * n - 1) * axial * y.at(index(n - 1, m)) -
                           static_cast<double>(n + m - 1) * y.at(index(n - 2, m))) /
                          static_cast<double>(n - m);
    y.at(index(n, n - 1)) = axial * sectorial;
    y.at(index(n, n)) = equatorial * sectorial;
  }
  return y;
}

double value(const Field& field, const Harmonics& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kTerms; ++i) sum += field.cosine.at(i) * y.at(i).real() + field.sine.at(i) * y.at(i).imag();
  return sum;
}

/// Limits the height to the range of validity of the formulas.
double within_the_air(double height) {
  return std::clamp(height, -500.0, 10000.0);
}

constexpr double kLapse = 0.0065;    // K/m, GPT's
constexpr double kDryAir = 287.054;  // J/(kg K)

/// On the geoid at 15, 30, 45, 60, 75 degrees of latitude: RTCA DO-229, A.4.2.4.
struct Vapour {
  Column temperature;  // K
  Column pressure;     // of the vapour, hPa
  Column lapse;        // beta, K/m
  Column decrease;     // lambda
};
constexpr Vapour kMeanVapour{{299.65, 294.15, 283.15, 272.15, 263.65},
                             {26.31, 21.79, 11.66, 6.78, 4.11},
                             {6.30e-3, 6.05e-3, 5.58e-3, 5.39e-3, 4.53e-3},
                             {2.77, 3.15, 2.57, 1.81, 1.55}};
constexpr Vapour kVapourAmplitude{{0.0, 7.0, 11.0, 15.0, 14.5},
                                  {0.0, 8.85, 7.24, 5.36, 3.39},
                                  {0.0, 0.25e-3, 0.32e-3, 0.81e-3, 0.62e-3},
                                  {0.0, 0.33, 0.46, 0.74, 0.30}};

struct MeanVapour {
  double pressure;  // hPa
  double decrease;
};
/// At a height above the geoid; `day` from 28 January.
MeanVapour mean_vapour(double latitude, double height, double day) {
  constexpr double kGravity = 9.80665;     // m/s^2, DO-229's
  constexpr double kSouth = 211.0 - 28.0;  // d, from the northern minimum to the southern
  // The step at the equator has no effect: up to 15 degrees the amplitudes are zero.
  const double season = std::cos(2.0 * geo::kPi * (latitude < 0.0 ? day - kSouth : day) / kYear);
  const auto of_day = [&](const Column Vapour::*column) {
    return at_latitude(kMeanVapour.*column, latitude) - season * at_latitude(kVapourAmplitude.*column, latitude);
  };
  const double lapse = of_day(&Vapour::lapse);
  const double decrease = of_day(&Vapour::decrease);
  const double cooled = 1.0 - lapse * height / of_day(&Vapour::temperature);
  return {of_day(&Vapour::pressure) * std::pow(cooled, (decrease + 1.0) * kGravity / (kDryAir * lapse)), decrease};
}

/// Of water vapour over liquid water, hPa: WMO-No. 8 (2008), annex 4.B.
double saturation_pressure(double celsius) {
  return 6.112 * std::exp(17.62 * celsius / (243.12 + celsius));
}

}  // namespace

double geoid_undulation(const geo::Geodetic& point) {
  return value(kUndulation, harmonics(point));
}

SurfaceWeather surface_weather(const geo::Geodetic& point, geo::GpsTime t) {
  const Harmonics y = harmonics(point);
  const double height = within_the_air(point.height) - value(kUndulation, y);
  const double day = (t - geo::GpsTime{}) / 86400.0 - 22.0;  // from 28 January 1980
  const double season = std::cos(2.0 * geo::kPi * day / kYear);
  const double pressure = value(kPressure, y) + season * value(kPressureAmplitude, y);
  const double celsius = value(kTemperature, y) + season * value(kTemperatureAmplitude, y) - kLapse * height;
  const MeanVapour vapour = mean_vapour(point.latitude, height, day);
  return {pressure * std::pow(1.0 - 2.26e-5 * height, 5.225), celsius + kFreezing,
          std::min(vapour.pressure, saturation_pressure(celsius)), vapour.decrease};
}

ZenithDelay zenith_delay(const SurfaceWeather& weather, const geo::Geodetic& point) {
  constexpr double kK2Prime = 16.52;  // K/hPa
  constexpr double kK3 = 377600.0;    // K^2/hPa
  const double gravity = 1.0 - 0.00266 * std::cos(2.0 * point.latitude) - 2.8e-7 * within_the_air(point.height);
  // T over this is the scale height of the vapour; K/m.
  const double decrease = 9.784 * gravity * (weather.vapour_decrease + 1.0) / kDryAir;
  const double temperature = weather.temperature_k * (1.0 - kLapse / decrease);
  return {0.0022768 * weather.pressure_hpa / gravity,
          1e-6 * (kK2Prime + kK3 / temperature) * weather.vapour_pressure_hpa / decrease};
}

}  // namespace coast::carrier
