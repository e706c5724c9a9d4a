// The catalogue: every entry complete, every equation what it says it is.

#include <gtest/gtest.h>

#include <set>

#include "coast/diagnose/effect.hpp"
#include "coast/geo/rotation.hpp"

namespace coast {
namespace {

using namespace diagnose;

Signals some_signals() {
  Signals s;
  s.omega = {0.1, -0.2, 0.3};
  s.f = {1.0, -2.0, -9.5};
  s.omega_dot = {0.4, 0.5, -0.6};
  s.vibration = {0.01, 0.02, 0.03};
  s.coning = {1e-4, 2e-4, 3e-4};
  s.temperature = 4.0;
  s.temperature_rate = 0.01;
  s.elapsed = 123.0;
  s.C_e_s = geo::dcm_from_euler({.roll = 0.1, .pitch = 0.2, .yaw = 2.0});
  s.C_n_e = geo::dcm_from_euler({.roll = -0.3, .pitch = 1.2, .yaw = 0.5});
  return s;
}

TEST(Catalogue, EveryEffectIsNamedOnceAndComplete) {
  std::set<std::pair<std::string_view, Site>> names;
  for (const Effect& e : catalogue()) {
    EXPECT_TRUE(names.insert({e.name, e.site}).second) << e.name;
    for (const std::string_view words : {e.name, e.parameter, e.unit, e.equation, e.meaning, e.separating_manoeuvre, e.source})
      EXPECT_FALSE(words.empty()) << e.name;
    EXPECT_FALSE(e.axes.empty()) << e.name;
    EXPECT_TRUE(e.sensors || e.position || e.slip) << e.name;
    for (std::size_t grade = 0; grade < 4; ++grade) EXPECT_GT(e.plausible[grade], 0.0) << e.name;
  }
  EXPECT_GE(catalogue().size(), 30U);
}

// An effect has as many columns as axes, and none of them is always zero.
TEST(Catalogue, EveryAxisActs) {
  const Signals signals = some_signals();
  FixSignals fix;
  fix.v_ea_e = {10.0, -3.0, 2.0};
  fix.a_ea_e = {1.0, 0.5, -0.2};
  fix.omega_b = {0.1, 0.0, 0.4};
  fix.elapsed = 55.0;
  fix.C_b_e = geo::dcm_from_euler({.roll = 0.1, .pitch = -0.2, .yaw = 1.0});
  fix.C_n_e = signals.C_n_e;
  for (const Effect& e : catalogue()) {
    const auto columns = static_cast<Eigen::Index>(e.axes.size());
    Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, columns);
    Eigen::Matrix3Xd part = sum, other = sum;
    if (e.sensors) {
      SensorErrors errors{part, other};
      e.sensors(signals, errors);
      sum += part.cwiseAbs() + other.cwiseAbs();
    }
    for (const auto& at_the_antenna : {e.position, e.velocity}) {
      if (!at_the_antenna) continue;
      part.setZero();
      at_the_antenna(fix, part);
      sum += part.cwiseAbs();
    }
    if (e.slip) {
      const estimate::NonHolonomic wheels{.pitch = 0.1, .yaw = -0.1};
      e.slip({{10.0, 0.5, -0.3}, wheels}, sum.topRows<2>());
      sum = sum.cwiseAbs();
    }
    EXPECT_TRUE((sum.colwise().sum().array() > 0.0).all()) << e.name;
  }
}

const Effect& effect(std::string_view name) {
  return *std::ranges::find(catalogue(), name, &Effect::name);
}

TEST(Catalogue, PairsAreResponseThenCause) {
  const Signals s = some_signals();
  const Effect& e = effect("gyro_g_sensitivity");
  Eigen::Matrix3Xd gyro = Eigen::Matrix3Xd::Zero(3, 9), accel = gyro;
  SensorErrors errors{gyro, accel};
  e.sensors(s, errors);
  const auto zy = std::ranges::find(e.axes, "zy") - e.axes.begin();
  EXPECT_EQ(gyro.col(zy), Eigen::Vector3d(0.0, 0.0, s.f.y()));
  EXPECT_TRUE(accel.isZero(0.0));
}

// Equivalences that no data can resolve (a lever arm common to all accelerometers; a turned mount).
TEST(Catalogue, SizeEffectCommonToAllAxesIsALeverArm) {
  const Signals s = some_signals();
  const Effect& e = effect("accel_size_effect");
  Eigen::Matrix3Xd gyro = Eigen::Matrix3Xd::Zero(3, 9), accel = gyro;
  SensorErrors errors{gyro, accel};
  e.sensors(s, errors);
  const Eigen::Vector3d r(0.1, -0.2, 0.3);
  Eigen::VectorXd common(9);
  common << r, r, r;
  const Eigen::Vector3d moved = s.omega_dot.cross(r) + s.omega.cross(s.omega.cross(r));
  EXPECT_TRUE((accel * common).isApprox(moved, 1e-12));
}

TEST(Catalogue, MountRotationTurnsBothTriads) {
  const Signals s = some_signals();
  Eigen::Matrix3Xd gyro = Eigen::Matrix3Xd::Zero(3, 3), accel = gyro;
  SensorErrors errors{gyro, accel};
  effect("imu_mount_rotation").sensors(s, errors);
  const Eigen::Vector3d theta(1e-6, -2e-6, 3e-6);
  const Eigen::Matrix3d turned = geo::rotation_matrix(theta).transpose();  // old axes to new ones
  EXPECT_TRUE((s.omega + gyro * theta).isApprox(turned * s.omega, 1e-10));
  EXPECT_TRUE((s.f + accel * theta).isApprox(turned * s.f, 1e-10));
}

}  // namespace
}  // namespace coast
