#include "coast/carrier/atmosphere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "latitude_table.hpp"

namespace coast::carrier {

namespace {

/// Marini's continued fraction in Herring's form: 1 at the zenith.
double continued_fraction(double sine, double a, double b, double c) {
  return (1.0 + a / (1.0 + b / (1.0 + c))) / (sine + a / (sine + b / (sine + c)));
}

/// Niell (1996), tables 3 and 4.
struct Coefficients {
  Column a, b, c;
};
constexpr Coefficients kAverage{{1.2769934e-3, 1.2683230e-3, 1.2465397e-3, 1.2196049e-3, 1.2045996e-3},
                                {2.9153695e-3, 2.9152299e-3, 2.9288445e-3, 2.9022565e-3, 2.9024912e-3},
                                {62.610505e-3, 62.837393e-3, 63.721774e-3, 63.824265e-3, 64.258455e-3}};
constexpr Coefficients kAmplitude{{0.0, 1.2709626e-5, 2.6523662e-5, 3.4000452e-5, 4.1202191e-5},
                                  {0.0, 2.1414979e-5, 3.0160779e-5, 7.2562722e-5, 11.723375e-5},
                                  {0.0, 9.0128400e-5, 4.3497037e-5, 84.795348e-5, 170.37206e-5}};
constexpr Coefficients kWet{{5.8021897e-4, 5.6794847e-4, 5.8118019e-4, 5.9727542e-4, 6.1641693e-4},
                            {1.4275268e-3, 1.5138625e-3, 1.4572752e-3, 1.5007428e-3, 1.7599082e-3},
                            {4.3472961e-2, 4.6729510e-2, 4.3908931e-2, 4.4626982e-2, 5.4736038e-2}};
constexpr double kHeightA = 2.53e-5, kHeightB = 5.49e-3, kHeightC = 1.14e-3;

}  // namespace

Direction direction_of(const Eigen::Vector3d& r_satellite_e, const Eigen::Vector3d& r_receiver_e) {
  const Eigen::Vector3d ned = geo::C_n_e(geo::geodetic_from_ecef(r_receiver_e)).transpose() * (r_satellite_e - r_receiver_e);
  const double azimuth = std::atan2(ned.y(), ned.x());
  return {azimuth < 0.0 ? azimuth + 2.0 * geo::kPi : azimuth, std::atan2(-ned.z(), std::hypot(ned.x(), ned.y()))};
}

double klobuchar_delay(const record::Klobuchar& model, const geo::Geodetic& receiver, const Direction& direction,
                       geo::GpsTime t) {
  constexpr double kLight = 299792458.0;
  constexpr double kDay = 86400.0;
  // Angles in semicircles, as in the published model.
  const double elevation = direction.elevation / geo::kPi;
  const double central = 0.0137 / (elevation + 0.11) - 0.022;
  const double latitude = std::clamp(receiver.latitude / geo::kPi + central * std::cos(direction.azimuth), -0.416, 0.416);
  const double longitude =
      receiver.longitude / geo::kPi + central * std::sin(direction.azimuth) / std::cos(latitude * geo::kPi);
  const double magnetic = latitude + 0.064 * std::cos((longitude - 1.617) * geo::kPi);
  const double local = std::fmod(std::fmod(kDay / 2.0 * longitude + t.sow(), kDay) + kDay, kDay);
  const double obliquity = 1.0 + 16.0 * std::pow(0.53 - elevation, 3);
  double amplitude = 0.0;
  double period = 0.0;
  for (std::size_t i = 4; i-- > 0;) {
    amplitude = amplitude * magnetic + model.alpha.at(i);
    period = period * magnetic + model.beta.at(i);
  }
  const double phase = 2.0 * geo::kPi * (local - 50400.0) / std::max(period, 72000.0);
  constexpr double kNight = 5e-9;  // s
  const double cosine = std::abs(phase) < 1.57 ? 1.0 - phase * phase * (0.5 - phase * phase / 24.0) : 0.0;
  return kLight * obliquity * (kNight + std::max(amplitude, 0.0) * cosine);
}

TroposphericMapping niell_mapping(const geo::Geodetic& receiver, double elevation, geo::GpsTime t) {
  if (!(elevation >= geo::kDegree))
    throw std::invalid_argument(fmt::format("niell_mapping: an elevation of {:.2f} degrees", elevation / geo::kDegree));
  const geo::Calendar date = t.calendar();
  const double day = (t - geo::GpsTime::from_calendar({date.year, 1, 1, 0, 0, 0.0})) / 86400.0 + 1.0;
  constexpr double kColdest = 28.0;  // day of year in the north
  const double season = std::cos(2.0 * geo::kPi * (day - kColdest) / 365.25) * (receiver.latitude < 0.0 ? -1.0 : 1.0);
  const auto hydrostatic = [&](const Column Coefficients::*column) {
    return at_latitude(kAverage.*column, receiver.latitude) - season * at_latitude(kAmplitude.*column, receiver.latitude);
  };
  const double sine = std::sin(elevation);
  const double dry =
      continued_fraction(sine, hydrostatic(&Coefficients::a), hydrostatic(&Coefficients::b), hydrostatic(&Coefficients::c));
  const double higher = 1.0 / sine - continued_fraction(sine, kHeightA, kHeightB, kHeightC);
  const auto wet = [&](const Column& column) { return at_latitude(column, receiver.latitude); };
  return {dry + higher * receiver.height / 1000.0, continued_fraction(sine, wet(kWet.a), wet(kWet.b), wet(kWet.c))};
}

}  // namespace coast::carrier
