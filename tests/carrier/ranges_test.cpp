// The way of a signal: against the same way in inertial axes, and what stands in the standards.

#include "coast/carrier/ranges.hpp"
#include "coast/carrier/surface_weather.hpp"

#include <gtest/gtest.h>

#include "coast/carrier/signals.hpp"
#include "coast/geo/units.hpp"

namespace coast::carrier {
namespace {

using record::Satellite;
using record::SatelliteSystem;

TEST(Frequencies, AreThoseOfTheStandards) {
  // RINEX 3.05, tables 4 to 10.
  EXPECT_EQ(carrier_frequency(SatelliteSystem::kGps, '2'), 1227.60e6);
  EXPECT_EQ(carrier_frequency(SatelliteSystem::kGalileo, '7'), 1207.14e6);
  EXPECT_EQ(carrier_frequency(SatelliteSystem::kGalileo, '8'), 1191.795e6);
  EXPECT_EQ(carrier_frequency(SatelliteSystem::kBeidou, '2'), 1561.098e6);
  EXPECT_EQ(carrier_frequency(SatelliteSystem::kBeidou, '6'), 1268.52e6);
  EXPECT_EQ(carrier_frequency(SatelliteSystem::kQzss, '6'), 1278.75e6);
  EXPECT_EQ(carrier_frequency(SatelliteSystem::kNavic, '9'), 2492.028e6);
  EXPECT_NEAR(*carrier_frequency(SatelliteSystem::kGlonass, '1', -7), 1598.0625e6, 1e-3);
  EXPECT_NEAR(*carrier_frequency(SatelliteSystem::kGlonass, '2', 6), 1248.625e6, 1e-3);
  EXPECT_FALSE(carrier_frequency(SatelliteSystem::kGps, '7'));
  EXPECT_FALSE(carrier_frequency(SatelliteSystem::kSbas, '2'));
}

/// A satellite that moves on a circle in inertial axes, which agree with ECEF at t0.
class Circling : public Orbits {
 public:
  explicit Circling(geo::GpsTime t0) : t0_(t0) {}
  [[nodiscard]] static Eigen::Vector3d inertial(double t) {
    constexpr double kRate = 1.458e-4;
    const double c = std::cos(kRate * t), s = std::sin(kRate * t);
    return 26560e3 * Eigen::Vector3d(c, 0.57 * s, 0.82 * s);
  }
  [[nodiscard]] std::optional<SatelliteState> at(Satellite, geo::GpsTime t) const override {
    SatelliteState state;
    const double after = t - t0_;
    state.r_e = Eigen::AngleAxisd(-geo::kEarthRate * after, Eigen::Vector3d::UnitZ()) * inertial(after);
    state.clock_s = 3e-4;
    return state;
  }

 private:
  geo::GpsTime t0_;
};

TEST(SignalPath, IsTheDistanceInInertialAxes) {
  const geo::GpsTime t0 = geo::GpsTime::from_week(2374, 208800.0);
  const Circling orbits(t0);
  const geo::Geodetic receiver{0.6, 0.2, 300.0};
  const Eigen::Vector3d r_e = geo::ecef_from_geodetic(receiver);  // at t0 the axes agree
  double tau = 0.07;
  for (int i = 0; i < 10; ++i) tau = (Circling::inertial(-tau) - r_e).norm() / kSpeedOfLight;
  const double range = tau * kSpeedOfLight;
  // What a receiver measures whose clock is 0.4 ms ahead, of a satellite whose clock is 0.3 ms ahead.
  const double pseudorange = range + kSpeedOfLight * (4e-4 - 3e-4);
  const auto satellite = at_transmission(orbits, {SatelliteSystem::kGps, 1}, t0 + 4e-4, pseudorange);
  ASSERT_TRUE(satellite);
  const SignalPath path = path_to(*satellite, r_e, receiver, t0, false);
  // Times are whole nanoseconds, in which a satellite moves 4 um.
  EXPECT_NEAR(path.range, range, 1e-5);
  EXPECT_NEAR(path.modelled(*satellite), range - kSpeedOfLight * 3e-4, 1e-5);
  EXPECT_EQ(path.troposphere, 0.0);
  const SignalPath with_air = path_to(*satellite, r_e, receiver, t0, true);
  const ZenithDelay zenith = zenith_delay(surface_weather(receiver, t0), receiver);
  // Saastamoinen over the sine of the elevation, to 2 % above 20 degrees.
  ASSERT_GT(path.direction.elevation, 20.0 * geo::kDegree);
  const double expected = (zenith.hydrostatic + zenith.wet) / std::sin(path.direction.elevation);
  EXPECT_NEAR(with_air.troposphere, expected, 0.02 * expected);
}

}  // namespace
}  // namespace coast::carrier
