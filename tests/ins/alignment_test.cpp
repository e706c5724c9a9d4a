#include "coast/ins/alignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/mounting.hpp"
#include "coast/record/error.hpp"
#include "coast/simulate/gnss.hpp"
#include "coast/simulate/imu.hpp"
#include "coast/simulate/motions.hpp"

namespace coast {
namespace {

using geo::kDegree;

struct Grade {
  double gyro_noise, accel_noise;  // rad/sqrt(s), m/s/sqrt(s)
  double gyro_bias, accel_bias;    // sd, rad/s, m/s^2
};
constexpr Grade kTactical{0.02 / 60.0 * kDegree, 0.03 / 60.0, 0.5 * kDegree / 3600.0, 3e-4};
constexpr Grade kConsumer{0.5 / 60.0 * kDegree, 0.3 / 60.0, 1.0 * kDegree, 0.1};
constexpr Grade kNavigation{0.002 / 60.0 * kDegree, 0.005 / 60.0, 0.005 * kDegree / 3600.0, 3e-4};

const geo::GpsTime kStart = geo::GpsTime::from_week(2300, 1000.0);

struct Mission {
  simulate::AnalyticTrajectory motion;
  record::ImuRecording imu;
  record::GnssRecording gnss;
  Eigen::Vector3d lever_arm_b;
  Eigen::Vector3d gyro_bias;
  Grade grade;

  [[nodiscard]] ins::AlignmentInput input() const {
    return {imu, gnss, lever_arm_b, grade.gyro_noise, grade.gyro_bias, grade.accel_bias};
  }
};

// C_s_b turns the IMU within the body: what is aligned then is the IMU's own frame.
Mission mission(const std::string& kind, const geo::Geodetic& origin, const Grade& grade, double begin, double gnss_rate_hz,
                const Eigen::Matrix3d& C_b_s = Eigen::Matrix3d::Identity()) {
  simulate::MotionParameters parameters;
  parameters.origin = origin;
  parameters.duration = kind == "aircraft_lines" ? 510.0 : 340.0;
  parameters.static_start = 30.0;
  parameters.course = 1.0;
  Mission m{simulate::make_motion(kind, parameters),
            {},
            {},
            C_b_s * Eigen::Vector3d(0.3, -0.2, -1.1),
            Eigen::Vector3d::Zero(),
            grade};
  m.imu = simulate::true_increments(m.motion, {kStart, 100.0, 5}, {Eigen::Vector3d::Zero(), C_b_s});
  m.imu.rate_hz = 100.0;
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal;
  const auto draw = [&](double sd) {
    return Eigen::Vector3d(sd * normal(generator), sd * normal(generator), sd * normal(generator));
  };
  m.gyro_bias = draw(grade.gyro_bias);
  const Eigen::Vector3d accel_bias = draw(grade.accel_bias);
  for (record::ImuSample& sample : m.imu.samples) {
    sample.dtheta += sample.dt * m.gyro_bias + draw(grade.gyro_noise * std::sqrt(sample.dt));
    sample.dv += sample.dt * accel_bias + draw(grade.accel_noise * std::sqrt(sample.dt));
  }
  const auto first =
      std::find_if(m.imu.samples.begin(), m.imu.samples.end(), [&](const auto& s) { return s.t - kStart > begin; });
  m.imu.samples.erase(m.imu.samples.begin(), first);
  simulate::GnssOptions options;
  options.rate_hz = gnss_rate_hz;
  options.lever_arm_b = {0.3, -0.2, -1.1};
  m.gnss = simulate::gnss_fixes(m.motion, kStart, options, 7);
  return m;
}

// Errors over stated sigmas: 4 sigma in each of nine components, one draw each, and a bound on what is stated.
void expect_aligned(const Mission& m, const ins::InitialState& state, const Eigen::Matrix3d& C_b_s, double heading_sd_deg) {
  const record::NavState truth = m.motion.nav_state(kStart, state.nav.t - kStart);
  const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(truth.r_eb_e)).transpose();
  const Eigen::Quaterniond q_s_e = truth.q_b_e * Eigen::Quaterniond(Eigen::Matrix3d(C_b_s.transpose()));
  const Eigen::Vector3d psi_n = C_e_n * geo::rotation_vector(state.nav.q_b_e * q_s_e.conjugate());
  const Eigen::Vector3d dr_n = C_e_n * (state.nav.r_eb_e - truth.r_eb_e);
  const Eigen::Vector3d dv_n = C_e_n * (state.nav.v_eb_e - truth.v_eb_e);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(psi_n(i)), 4.0 * state.sd_attitude_n(i)) << "attitude " << i << ", " << state.method;
    EXPECT_LT(std::abs(dr_n(i)), 4.0 * state.sd_position_n(i)) << "position " << i << ", " << state.method;
    EXPECT_LT(std::abs(dv_n(i)), 4.0 * state.sd_velocity_n(i)) << "velocity " << i << ", " << state.method;
  }
  EXPECT_LT(state.sd_attitude_n.z(), heading_sd_deg * kDegree) << state.method;
  EXPECT_LT(state.sd_position_n.norm(), 0.5);
  EXPECT_LT(state.sd_velocity_n.norm(), 0.5);
}

TEST(Alignment, StandingStartAtEveryLatitude) {
  for (double latitude : {-78.0, -35.0, 0.0, 46.5, 80.0}) {
    const Mission m = mission("car_straight", {latitude * kDegree, -2.0, 400.0}, kConsumer, 0.0, 5.0);
    const ins::InitialState state = ins::align(m.input(), false);
    expect_aligned(m, state, Eigen::Matrix3d::Identity(), 2.0);
    // The static mean of 30 s carries 0.5 deg/sqrt(h): 0.0015 deg/s; the Earth's rate is 0.0042 deg/s.
    EXPECT_LT((state.gyro_bias - m.gyro_bias).norm(), 0.008 * kDegree);
    EXPECT_NE(state.method.find("standing still"), std::string::npos);
  }
}

TEST(Alignment, MovingStartOfEveryMotionInBothHemispheres) {
  double latitude = 46.5;
  for (const simulate::MotionKind& kind : simulate::motions()) {
    if (kind.name == "at_rest") continue;  // never moves
    SCOPED_TRACE(kind.name);
    latitude = latitude > 0.0 ? -35.0 : 46.5;
    const Mission m = mission(std::string(kind.name), {latitude * kDegree, 0.1, 400.0}, kTactical, 150.7, 10.0);
    const ins::InitialState state = ins::align(m.input(), false);
    expect_aligned(m, state, Eigen::Matrix3d::Identity(), 2.0);
    const Eigen::Vector3d up = state.nav.r_eb_e.normalized();
    const Eigen::Quaterniond truth = m.motion.nav_state(kStart, state.nav.t - kStart).q_b_e;
    const Eigen::Vector3d psi_e = geo::rotation_vector(state.nav.q_b_e * truth.conjugate());
    // Errors of 1 cm in the first and last second difference of 20 s leave 0.014 / 20 m/s^2, twice that in the short windows
    // of the ski; an Earth that does not turn would leave half of 20 s x 15 deg/h.
    EXPECT_LT((psi_e - up * up.dot(psi_e)).norm(), 0.05 * kDegree);
  }
}

TEST(Alignment, MovingStartWithLargeUnknownBiases) {
  for (const char* kind : {"car_roundabout", "ski"}) {
    const Mission m = mission(kind, {0.8, 0.1, 400.0}, kConsumer, 45.3, 1.0);
    const ins::InitialState state = ins::align(m.input(), false);
    SCOPED_TRACE(kind);
    expect_aligned(m, state, Eigen::Matrix3d::Identity(), 3.0);
    EXPECT_LT((state.gyro_bias - m.gyro_bias).norm(), 0.05 * m.gyro_bias.norm());
  }
}

TEST(Alignment, TheBodyNeedNotPointAlongTheCourse) {
  // The IMU looks sideways and lies on its back: heading by course would be 115 deg off.
  const Eigen::Matrix3d C_b_s = geo::dcm_from_euler({2.9, 0.3, 2.0}).transpose();
  for (double begin : {0.0, 150.7}) {
    const Mission m = mission("city", {-0.6, 2.5, 50.0}, kTactical, begin, 5.0, C_b_s);
    expect_aligned(m, ins::align(m.input(), false), C_b_s, 2.0);
  }
}

TEST(Alignment, VehicleForwardHelpsWhereAccelerationDoesNot) {
  // A minute with fixes of ten metres: their second differences drown the forces, the course stands.
  Mission m = mission("car_straight", {0.8, 0.1, 400.0}, kTactical, 130.0, 1.0);
  for (record::GnssFix& fix : m.gnss.fixes) fix.position_cov_n *= 1e6;  // as stated: sd 10 and 20 m
  m.imu.samples.resize(6000);
  EXPECT_THROW((void)ins::align(m.input(), false), NumericalError);
  const ins::InitialState state = ins::align(m.input(), true);
  const record::NavState truth = m.motion.nav_state(kStart, state.nav.t - kStart);
  EXPECT_LT(state.nav.q_b_e.angularDistance(truth.q_b_e), 8.0 * kDegree);  // kSideslip of 4 deg, twice
}

TEST(Alignment, AttitudeIsCarriedBackToTheStartByTheGyro) {
  // Three seconds of fixes, then none for 75: the first window that tells anything begins 20 s after the start, several turns
  // later.
  Mission m = mission("city", {0.8, 0.1, 400.0}, kTactical, 140.0, 5.0);
  const auto hidden = [](const record::GnssFix& fix) { return fix.t - kStart > 143.0 && fix.t - kStart < 218.0; };
  m.gnss.fixes.erase(std::remove_if(m.gnss.fixes.begin(), m.gnss.fixes.end(), hidden), m.gnss.fixes.end());
  m.gnss.fixes.erase(m.gnss.fixes.begin(), m.gnss.fixes.begin() + 700);
  const auto q_b_e = [&](double t) { return m.motion.nav_state(kStart, t).q_b_e; };
  ASSERT_GT(q_b_e(140.0).angularDistance(q_b_e(160.0)), 1.0);
  const ins::InitialState state = ins::align(m.input(), false);
  EXPECT_NE(state.method.find("from 20.0 s"), std::string::npos) << state.method;
  expect_aligned(m, state, Eigen::Matrix3d::Identity(), 5.0);
}

TEST(Alignment, GyrocompassingAtRest) {
  for (double latitude : {-50.0, 3.0, 60.0}) {
    Mission m = mission("car_straight", {latitude * kDegree, 0.1, 400.0}, kNavigation, 0.0, 1.0);
    m.imu.samples.resize(2900);  // nothing but standstill: only the Earth's rate shows north
    const ins::InitialState state = ins::align(m.input(), false);
    expect_aligned(m, state, Eigen::Matrix3d::Identity(), 1.0);
    EXPECT_NE(state.method.find("gyrocompassing"), std::string::npos);
  }
}

TEST(Alignment, SaysWhatToDoWhereThereIsNoHeading) {
  Mission m = mission("car_straight", {0.8, 0.1, 400.0}, kConsumer, 0.0, 1.0);
  m.imu.samples.resize(2900);  // standstill with a gyro that cannot feel the Earth
  try {
    (void)ins::align(m.input(), false);
    FAIL() << "a heading out of nothing";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("start:"), std::string::npos) << error.what();
  }
  m.gnss.fixes.erase(m.gnss.fixes.begin(), m.gnss.fixes.begin() + 200);
  EXPECT_THROW((void)ins::align(m.input(), false), NumericalError);  // no overlap
  m.gnss.fixes.clear();
  EXPECT_THROW((void)ins::align(m.input(), false), NumericalError);
}

TEST(StaticPeriods, FindsStandstillUnderAShakingEngineAndNoMore) {
  Mission m = mission("city", {0.8, 0.1, 400.0}, kTactical, 0.0, 4.0);
  // An engine: 2.3 deg/s and 0.5 m/s^2 at 25 Hz, where the car stands as well as where it drives.
  for (record::ImuSample& sample : m.imu.samples) {
    const double phase = std::sin(2.0 * geo::kPi * 25.3 * (sample.t - kStart));
    sample.dtheta.y() += sample.dt * 2.3 * kDegree * phase;
    sample.dv.z() += sample.dt * 0.5 * phase;
  }
  const auto periods = ins::find_static_periods(m.imu, &m.gnss);
  ASSERT_FALSE(periods.empty());
  EXPECT_EQ(periods.front().first, 0U);
  EXPECT_GT(m.imu.samples[periods.front().last].t - kStart, 29.0);  // it stands for 30 s
  double standing = 0.0, found = 0.0, wrong = 0.0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < m.imu.samples.size(); ++i) {
    const bool stands = m.motion.nav_state(kStart, m.imu.samples[i].t - kStart).v_eb_e.norm() < 0.02;
    while (next < periods.size() && periods[next].last < i) ++next;
    const bool inside = next < periods.size() && periods[next].first <= i;
    standing += stands ? 0.01 : 0.0;
    found += stands && inside ? 0.01 : 0.0;
    const bool moves = m.motion.nav_state(kStart, m.imu.samples[i].t - kStart).v_eb_e.norm() > 0.2;
    wrong += moves && inside ? 0.01 : 0.0;
  }
  EXPECT_GT(found, 0.8 * standing);  // the edges of each stop are within a second of motion
  EXPECT_LT(wrong, 0.01 * standing);
}

TEST(StaticPeriods, EvenMotionIsNotStandstillWhereGnssMoves) {
  Mission m = mission("car_straight", {0.8, 0.1, 400.0}, kTactical, 0.0, 1.0);
  m.imu.samples.resize(2500);  // an IMU at rest feels what one in even motion feels
  EXPECT_EQ(ins::find_static_periods(m.imu, &m.gnss).size(), 1U);
  for (record::GnssFix& fix : m.gnss.fixes) fix.r_ea_e += Eigen::Vector3d(0.3, 0.2, 0.4) * (fix.t - kStart);
  EXPECT_TRUE(ins::find_static_periods(m.imu, &m.gnss).empty());
  EXPECT_EQ(ins::find_static_periods(m.imu, nullptr).size(), 1U);
  EXPECT_TRUE(ins::find_static_periods(m.imu, nullptr, 30.0).empty());  // shorter than asked for
}

}  // namespace
}  // namespace coast
