#include "coast/ins/strapdown.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/reversal.hpp"
#include "ins/motion.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

record::NavState at_rest(const geo::Geodetic& p, const geo::Euler& attitude = {}) {
  record::NavState state;
  state.t = geo::GpsTime::from_week(2200, 1000.0);
  state.r_eb_e = geo::ecef_from_geodetic(p);
  state.q_b_e = Eigen::Quaterniond(geo::C_n_e(p) * geo::dcm_from_euler(attitude));
  return state;
}

// What sensors at rest on the turning Earth measure over dt.
ins::BodyIncrement rest_increment(const record::NavState& state, double dt) {
  const Eigen::Matrix3d C_e_b = state.q_b_e.conjugate().toRotationMatrix();
  ins::RawIncrement raw;
  raw.dt = dt;
  raw.dtheta = C_e_b * Eigen::Vector3d(0.0, 0.0, geo::kEarthRate * dt);
  raw.dv = -dt * (C_e_b * geo::gravity_e(state.r_eb_e));
  return ins::compensate_two_sample(raw, raw);
}

TEST(Strapdown, StaysAtRestOnTheTurningEarth) {
  for (double latitude : {-90.0, -47.0, -0.001, 0.0, 23.0, 60.0, 90.0}) {
    const record::NavState start = at_rest({latitude * geo::kDegree, 2.0, 300.0}, {0.1, -0.2, 2.5});
    ins::Strapdown strapdown(start);
    const ins::BodyIncrement increment = rest_increment(start, 0.01);
    for (int i = 0; i < 60000; ++i) strapdown.step(increment);
    // The same rounding of 2e-16 rad in each of 60000 equal steps, in the worst case; as a tilt it lets gravity in for 600 s.
    EXPECT_LT(strapdown.state().q_b_e.angularDistance(start.q_b_e), 3e-11) << latitude;
    EXPECT_LT(strapdown.state().v_eb_e.norm(), 3e-11 * 9.8 * 300.0) << latitude;
    EXPECT_LT((strapdown.state().r_eb_e - start.r_eb_e).norm(), 3e-11 * 9.8 * 600.0 * 100.0) << latitude;
    EXPECT_NEAR(strapdown.state().t - start.t, 600.0, 1e-9);
  }
}

TEST(Strapdown, FreeFallAtTheEquatorDriftsEastAsCoriolisSays) {
  const geo::Geodetic p{0.0, 0.3, 1000.0};
  ins::Strapdown strapdown(at_rest(p));
  const double fall_s = 10.0;
  for (int i = 0; i < 1000; ++i)
    strapdown.step({0.01, Eigen::Vector3d(0.0, geo::kEarthRate * -0.01, 0.0), Eigen::Vector3d::Zero()});
  const Eigen::Vector3d ned = geo::LocalFrame(p).to_ned(strapdown.state().r_eb_e);
  const double g = geo::gravity_e(geo::ecef_from_geodetic(p)).norm();
  // Closed forms to first order in w and in depth/radius: g t^2/2 (1 + g t^2/(6 R)), w g t^3/3; the next terms are below 1e-4
  // of them.
  const double gradient = 1.0 + 2.0 * g * fall_s * fall_s / (12.0 * 6.37e6);
  EXPECT_NEAR(ned.z(), 0.5 * g * fall_s * fall_s * gradient, 3e-3);
  EXPECT_NEAR(ned.y(), geo::kEarthRate * g * std::pow(fall_s, 3) / 3.0, 1e-4 * 0.24);
  EXPECT_NEAR(ned.x(), 0.0, 1e-9);
}

TEST(Strapdown, SchulerOscillationHasThePeriodOfTheLocalRadius) {
  // On an Earth that stands still the horizontal error obeys x'' = -g/R x, R the radius of curvature along x (the ellipsoid is
  // a level surface of normal gravity). 84.4 min.
  const geo::Geodetic p{0.0, 1.0, 0.0};
  const record::NavState start = at_rest(p);
  const double g = geo::gravity_e(start.r_eb_e).norm();
  const geo::Radii radii = geo::radii_of_curvature(p.latitude);
  const geo::LocalFrame frame(p);
  for (int axis : {0, 1}) {
    record::NavState moving = start;
    moving.v_eb_e = geo::C_n_e(p).col(axis);
    ins::Strapdown strapdown(moving, 0.0);
    const Eigen::Vector3d u = -(start.q_b_e.conjugate() * geo::gravity_e(start.r_eb_e));
    double last = 0.0;
    double half_period = 0.0;
    for (int i = 1; half_period == 0.0 && i < 4000; ++i) {
      strapdown.step({1.0, Eigen::Vector3d::Zero(), u});
      const double x = frame.to_ned(strapdown.state().r_eb_e)(axis);
      if (i > 100 && x <= 0.0) half_period = i - 1 + last / (last - x);
      last = x;
    }
    const double expected = 2.0 * geo::kPi * std::sqrt((axis == 0 ? radii.meridian : radii.prime_vertical) / g);
    EXPECT_NEAR(expected / 60.0, 84.4, 0.5);
    EXPECT_NEAR(2.0 * half_period, expected,
                0.02);  // s; gravity to 1.8e-9 of the 1.2e-3 m/s^2 that restore: 1.5e-6 of the period, twice
  }
}

TEST(Strapdown, AttitudeIsExactWhenTurningFastAndStaysOrthonormal) {
  record::NavState start = at_rest({0.5, 0.1, 0.0});
  ins::Strapdown strapdown(start);
  const Eigen::Vector3d phi(0.03, -0.05, 0.04);
  for (int i = 0; i < 100000; ++i) strapdown.step({0.01, phi, Eigen::Vector3d::Zero()});
  // Axis-angle of the whole, written without this library's exponential.
  const double angle = 1e5 * phi.norm();
  const Eigen::Quaterniond expected =
      Eigen::Quaterniond(Eigen::AngleAxisd(-geo::kEarthRate * 1000.0, Eigen::Vector3d::UnitZ())) * start.q_b_e *
      Eigen::Quaterniond(Eigen::AngleAxisd(std::fmod(angle, 2.0 * geo::kPi), phi.normalized()));
  EXPECT_LT(strapdown.state().q_b_e.angularDistance(expected), 1e-10);  // 1e5 roundings of 1e-16, and of the angle 7e3 rad
  EXPECT_NEAR(strapdown.state().q_b_e.norm(), 1.0, 1e-15);
  test::expect_near_matrix(strapdown.C_b_e(), strapdown.state().q_b_e.toRotationMatrix(), 1e-15, "matrix and quaternion");
}

TEST(Strapdown, CorrectSetsTheStateAndKeepsTime) {
  ins::Strapdown strapdown(at_rest({0.5, 0.1, 0.0}));
  const geo::GpsTime t = strapdown.state().t;
  const Eigen::Quaterniond unnormalised(2.0, 0.0, 0.0, 2.0);
  strapdown.correct({1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, unnormalised);
  EXPECT_EQ(strapdown.state().t, t);
  EXPECT_EQ(strapdown.state().r_eb_e, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(strapdown.state().v_eb_e, Eigen::Vector3d(4.0, 5.0, 6.0));
  test::expect_near_matrix(strapdown.C_b_e(), Eigen::AngleAxisd(geo::kPi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                           1e-15, "C_b_e");
}

TEST(Strapdown, LastVelocityIncrementIsThatOfTheSpecificForce) {
  const record::NavState start = at_rest({0.9, 0.4, 100.0}, {0.3, 0.1, -1.0});
  ins::Strapdown strapdown(start);
  strapdown.step(rest_increment(start, 0.005));
  test::expect_near_matrix(strapdown.last_dv_e(), -0.005 * geo::gravity_e(start.r_eb_e), 1e-12, "C u at rest");
}

// A driven body: raw increments of waves, as if they had been recorded.
record::ImuRecording driven(const record::NavState& start, double duration_s) {
  const test::Motion motion = test::shaking(2.0);
  record::ImuRecording recording;
  for (int i = 0; i < std::lround(duration_s * 100.0); ++i) {
    const ins::RawIncrement raw = motion.increment(0.01 * i, 0.01 * (i + 1));
    recording.samples.push_back({start.t + 0.01 * (i + 1), 0.01, raw.dtheta, raw.dv - Eigen::Vector3d(0.0, 0.0, 0.196)});
  }
  return recording;
}

TEST(Reversal, ForwardThenBackwardReturnsToTheStart) {
  for (double latitude : {-1.2, 0.0, 0.8}) {
    const record::NavState start = at_rest({latitude, -2.0, 500.0}, {0.02, 0.03, 1.0});
    record::ImuRecording recording = driven(start, 60.0);
    ins::Strapdown forward(start);
    for (record::ImuSample& sample : recording.samples) {
      const ins::BodyIncrement body = ins::compensate_two_sample({}, {sample.dt, sample.dtheta, sample.dv});
      forward.step(body);
      sample.dtheta = body.phi;
      sample.dv = body.u;
    }
    EXPECT_GT((forward.state().r_eb_e - start.r_eb_e).norm(), 100.0);
    const geo::GpsTime mirror = start.t;
    ins::reverse(recording, mirror, ins::IncrementKind::kCompensated);
    ins::Strapdown backward(ins::reversed(forward.state(), mirror), -geo::kEarthRate);
    for (const record::ImuSample& sample : recording.samples) backward.step({sample.dt, sample.dtheta, sample.dv});
    const record::NavState back = ins::reversed(backward.state(), mirror);
    // 6000 steps there and back: rounding of positions (1e-9 m), and the mid-interval Coriolis that is not symmetric to (w
    // dt)^2 dv.
    EXPECT_LT((back.r_eb_e - start.r_eb_e).norm(), 1e-6);
    EXPECT_LT((back.v_eb_e - start.v_eb_e).norm(), 1e-8);
    EXPECT_LT(back.q_b_e.angularDistance(start.q_b_e), 1e-12);
    EXPECT_NEAR(back.t - start.t, 0.0, 1e-9);
  }
}

TEST(Reversal, RawIncrementsCompensateToTheReversedIncrement) {
  // Compensating the mirrored raw intervals gives the mirror of compensating the raw ones, to the order of the two samples.
  const test::Motion motion = test::shaking(0.5);
  record::ImuRecording recording;
  for (int i = 0; i < 3; ++i) {
    const ins::RawIncrement raw = motion.increment(0.01 * i, 0.01 * (i + 1));
    recording.samples.push_back({geo::GpsTime::from_week(2200, 0.01 * (i + 1)), 0.01, raw.dtheta, raw.dv});
  }
  const ins::BodyIncrement exact{0.01, geo::rotation_vector(motion.rotation(0.01, 0.02)), motion.velocity_change(0.01, 0.02)};
  const ins::BodyIncrement mirrored = ins::reversed(exact);
  ins::reverse(recording, geo::GpsTime::from_week(2200, 0.03));
  const auto raw = [&](std::size_t i) { return ins::RawIncrement{0.01, recording.samples[i].dtheta, recording.samples[i].dv}; };
  const ins::BodyIncrement body = ins::compensate_two_sample(raw(0), raw(1));
  EXPECT_LT((body.phi - mirrored.phi).norm(), 1e-7);
  EXPECT_LT((body.u - mirrored.u).norm(), 1e-6);
  EXPECT_GT((body.u + ins::reversed(mirrored).u - 2.0 * mirrored.u).norm(), 1e-5);  // the frame in which u stands matters
}

TEST(Reversal, TwiceIsTheIdentity) {
  const record::NavState start = at_rest({0.3, 0.2, 0.0});
  record::ImuRecording recording = driven(start, 1.0);
  recording.temperature.resize(100);
  recording.temperature[7] = 20.5F;
  const record::ImuRecording original = recording;
  const geo::GpsTime mirror = start.t + 12.3;
  ins::reverse(recording, mirror);
  EXPECT_EQ(recording.temperature[92], 20.5F);
  for (std::size_t i = 1; i < recording.samples.size(); ++i) {
    EXPECT_LT(recording.samples[i - 1].t, recording.samples[i].t);
    EXPECT_NEAR(recording.samples[i].t - recording.samples[i - 1].t, recording.samples[i].dt, 1.1e-9);
  }
  ins::reverse(recording, mirror);
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    EXPECT_EQ(recording.samples[i].t, original.samples[i].t);
    EXPECT_EQ(recording.samples[i].dtheta, original.samples[i].dtheta);
    EXPECT_EQ(recording.samples[i].dv, original.samples[i].dv);
  }
  record::GnssRecording gnss;
  gnss.fixes.resize(2);
  gnss.fixes[0].t = start.t;
  gnss.fixes[1].t = start.t + 1.0;
  gnss.fixes[1].velocity = record::GnssFix::Velocity{Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Matrix3d::Identity()};
  ins::reverse(gnss, start.t + 1.0);
  EXPECT_EQ(gnss.fixes[0].t, start.t + 1.0);
  EXPECT_EQ(gnss.fixes[0].velocity->v_ea_n, Eigen::Vector3d(-1.0, -2.0, -3.0));
  EXPECT_EQ(gnss.fixes[1].t, start.t + 2.0);
}

}  // namespace
}  // namespace coast
