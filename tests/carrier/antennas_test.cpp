// Phase centres against their own definition.

#include "coast/carrier/antennas.hpp"
#include "coast/carrier/orbits.hpp"
#include "coast/carrier/solid_tides.hpp"

#include <gtest/gtest.h>

#include "coast/geo/units.hpp"
#include "simulated.hpp"

namespace coast::carrier {
namespace {

using record::SatelliteSystem;

record::AntennaCalibration antenna() {
  record::AntennaCalibration a;
  a.type = "MADE1           NONE";
  record::PhaseCentre centre;
  centre.offset = {0.002, -0.001, 0.09};
  centre.first = 0.0;
  centre.step = 45.0 * geo::kDegree;
  // Rows at 0, 90, 180, 270 and 360 degrees, columns at 0, 45 and 90 degrees from the zenith.
  centre.variations = {{0.0, 0.001, 0.003}, {0.0, 0.002, 0.005}, {0.0, 0.001, 0.003}, {0.0, 0.0, 0.001}, {0.0, 0.001, 0.003}};
  a.bands[{SatelliteSystem::kGps, '1'}] = centre;
  centre.offset = {0.0, 0.0, 0.12};
  centre.variations = {{0.0, 0.0, 0.0}};
  a.bands[{SatelliteSystem::kGps, '2'}] = centre;
  return a;
}

TEST(PhaseCentre, IsVariationLessOffsetAlongTheWay) {
  const record::AntennaCalibration a = antenna();
  EXPECT_NEAR(phase_centre_correction(a, SatelliteSystem::kGps, '1', {0.0, 90.0 * geo::kDegree}), -0.09, 1e-12);
  const double root = std::sqrt(0.5);
  EXPECT_NEAR(phase_centre_correction(a, SatelliteSystem::kGps, '1', {90.0 * geo::kDegree, 45.0 * geo::kDegree}),
              0.002 - root * (0.09 - 0.001), 1e-12);
  // Halfway between rows and columns.
  const double c = std::cos(67.5 * geo::kDegree), s = std::sin(67.5 * geo::kDegree);
  EXPECT_NEAR(phase_centre_correction(a, SatelliteSystem::kGps, '1', {45.0 * geo::kDegree, 67.5 * geo::kDegree}),
              0.25 * (0.0 + 0.0 + 0.001 + 0.002) - (c * root * 0.002 - c * root * 0.001 + s * 0.09), 1e-12);
  // Galileo's E5a lies next to L2.
  EXPECT_NEAR(phase_centre_correction(a, SatelliteSystem::kGalileo, '5', {0.0, 90.0 * geo::kDegree}), -0.12, 1e-12);
  EXPECT_EQ(phase_centre_correction({}, SatelliteSystem::kGps, '1', {0.0, 1.0}), 0.0);
}

TEST(PhaseCentre, IsFoundByNameOrWithoutItsRadome) {
  record::AntennaTable table;
  table.antennas.push_back(antenna());
  EXPECT_EQ(find_antenna(table, "MADE1           NONE"), &table.antennas[0]);
  EXPECT_EQ(find_antenna(table, "MADE1           SCIS"), &table.antennas[0]);
  EXPECT_EQ(find_antenna(table, "MADE1"), &table.antennas[0]);
  EXPECT_EQ(find_antenna(table, "MADE2           NONE"), nullptr);
}

TEST(PhaseCentre, MovesThePositionByItsOffset) {
  const SimulatedBaseline mission("car_roundabout", 360.0, error_free());
  PpkOptions options;
  options.differences.rover_antenna = antenna();
  for (auto& [band, centre] : options.differences.rover_antenna->bands) {
    centre.offset = {0.0, 0.0, 0.1};
    centre.variations = {{0.0, 0.0, 0.0}};
  }
  const PpkSolution solution = mission.solve(options);
  for (const PpkEpoch& epoch : solution.epochs) {
    const Eigen::Vector3d truth = mission.truth(epoch.t).r_eb_e;
    const Eigen::Vector3d off_n = geo::C_n_e(geo::geodetic_from_ecef(truth)).transpose() * (epoch.r_e - truth);
    // What was observed is the phase centre: the reference point lies 10 cm below. Quantised phases move it by 2 mm.
    EXPECT_LT((off_n - Eigen::Vector3d(0.0, 0.0, 0.1)).norm(), 2e-3);
  }
}

/// A satellite that stands still.
class Still : public Orbits {
 public:
  [[nodiscard]] std::optional<SatelliteState> at(record::Satellite /*satellite*/, geo::GpsTime /*t*/) const override {
    SatelliteState state;
    state.r_e = {2.6e7, 0.0, 0.0};
    return state;
  }
};

TEST(PhaseCentredOrbits, CarryTheOffsetsOfTheTimeInYawSteeringAxes) {
  const geo::GpsTime t = geo::GpsTime::from_calendar({2020, 6, 25, 10, 0, 0.0});
  record::AntennaCalibration now;
  now.satellite = record::Satellite{SatelliteSystem::kGps, 1};
  now.from = t - 1e6;
  now.bands[{SatelliteSystem::kGps, '1'}].offset = {0.4, 0.0, 1.5};
  now.bands[{SatelliteSystem::kGps, '2'}].offset = {0.4, 0.0, 1.5};
  record::AntennaCalibration before = now;
  before.from.reset();
  before.until = t - 1e6;
  before.bands[{SatelliteSystem::kGps, '1'}].offset = {0.0, 0.0, 9.0};
  const Still still;
  const PhaseCentredOrbits orbits(still, {"", {before, now}, {}});
  const Eigen::Vector3d moved = orbits.at({SatelliteSystem::kGps, 1}, t)->r_e - still.at({}, t)->r_e;
  // Both bands alike: so is any combination. 1.5 m to the Earth, 0.4 m across it to the side of the Sun.
  EXPECT_NEAR(moved.x(), -1.5, 1e-9);
  EXPECT_NEAR(moved.tail<2>().norm(), 0.4, 1e-9);
  EXPECT_GT(moved.tail<2>().dot(sun_e(t).tail<2>()), 0.0);
  EXPECT_EQ(orbits.at({SatelliteSystem::kGps, 2}, t)->r_e, still.at({}, t)->r_e);  // nothing is known of it
  // L1 alone moved by 1 mm moves the combination by f1^2 / (f1^2 - f2^2) = 2.546 mm.
  now.bands[{SatelliteSystem::kGps, '1'}].offset.z() += 0.001;
  const PhaseCentredOrbits other(still, {"", {now}, {}});
  EXPECT_NEAR(other.at({SatelliteSystem::kGps, 1}, t)->r_e.x() - orbits.at({SatelliteSystem::kGps, 1}, t)->r_e.x(), -0.002546,
              1e-6);
}

TEST(YawSteering, AxesAreRightHandedAndFaceEarthAndSun) {
  const Eigen::Vector3d r_e(1.5e7, -1.2e7, 1.8e7), r_sun_e(-9e10, 1.1e11, 4e10);
  const Eigen::Matrix3d axes = yaw_steering_axes(r_e, r_sun_e);
  EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
  EXPECT_NEAR(axes.col(2).dot(r_e.normalized()), -1.0, 1e-12);
  EXPECT_NEAR(axes.col(1).dot((r_sun_e - r_e).normalized()), 0.0, 1e-12);
  EXPECT_GT(axes.col(0).dot(r_sun_e), 0.0);
}

}  // namespace
}  // namespace coast::carrier
