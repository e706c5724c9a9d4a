#include "coast/io/inspect.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using geo::GpsTime;
using test::count_of;

/// A level car: stands 20 s, then drives with changing speed and changing turn rate. Flat Earth, no Earth rate: what the
/// inspection looks at is larger by orders.
struct Car {
  double heading = 0.3, speed = 0.0, north = 0.0, east = 0.0;
  [[nodiscard]] static double acceleration(double t) {
    if (t < 20.0) return 0.0;
    return t < 24.0 ? 3.0 : 1.5 * std::sin(0.7 * (t - 24.0));
  }
  [[nodiscard]] static double turn_rate(double t) {
    return t < 24.0 ? 0.0 : 0.3 * std::sin(0.4 * (t - 24.0)) * std::sin(0.061 * t);
  }
  void step(double t, double dt) {
    heading += turn_rate(t) * dt;
    speed += acceleration(t) * dt;
    north += speed * std::cos(heading) * dt;
    east += speed * std::sin(heading) * dt;
  }
};

struct Recording {
  record::ImuRecording imu;
  record::GnssRecording gnss;
};

/// @param C_body_sensor axes of the recording in terms of forward-right-down  @param shift GNSS times are too late by it
Recording drive(const Eigen::Matrix3d& C_body_sensor, double shift, double gyro_scale = 1.0, double force_scale = 1.0) {
  constexpr double kDt = 0.01;
  const GpsTime start = GpsTime::from_week(2300, 1000.0);
  const geo::LocalFrame frame({0.8, 0.1, 200.0});
  const double g = geo::gravity_e(frame.to_ecef({0.0, 0.0, 0.0})).norm();
  Recording r;
  Car car;
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (int i = 1; i <= 20000; ++i) {
    const double middle = (i - 0.5) * kDt;
    car.step(middle, kDt);
    record::ImuSample s;
    s.t = start + i * kDt;
    s.dt = kDt;
    s.dtheta = gyro_scale * kDt * (C_body_sensor * Eigen::Vector3d(0.0, 0.0, Car::turn_rate(middle)));
    s.dv = force_scale * kDt *
           (C_body_sensor * Eigen::Vector3d(Car::acceleration(middle), car.speed * Car::turn_rate(middle), -g));
    for (int j = 0; j < 3; ++j) {  // noise of a good MEMS IMU: no two samples are alike
      s.dtheta[j] += 1e-4 * kDt * normal(generator);
      s.dv[j] += 1e-3 * kDt * normal(generator);
    }
    r.imu.samples.push_back(s);
    if (i % 20 != 0) continue;
    record::GnssFix fix;
    fix.t = s.t + shift;
    fix.r_ea_e = frame.to_ecef({car.north, car.east, 0.0});
    fix.position_cov_n = 1e-4 * Eigen::Matrix3d::Identity();
    fix.quality = record::FixQuality::kFixed;
    r.gnss.fixes.push_back(fix);
  }
  r.imu.rate_hz = 100.0;
  return r;
}

const Eigen::Matrix3d kFrd = Eigen::Matrix3d::Identity();

Eigen::Matrix3d rows(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
  Eigen::Matrix3d m;
  m << x.transpose(), y.transpose(), z.transpose();
  return m;
}

std::string text_of(const Inspection& result, const std::string& kind) {
  for (const auto& event : result.events)
    if (event.kind == kind) return event.text;
  return "";
}

TEST(Inspect, NothingWrongNothingWarned) {
  const Recording r = drive(kFrd, 0.0);
  const Inspection result = inspect(r.imu, r.gnss);
  EXPECT_TRUE(result.events.empty()) << result.events.front().text;
  EXPECT_NEAR(result.overlap_s, 199.8, 1e-6);
  EXPECT_TRUE(result.rest_seen);
  test::expect_near_matrix(*result.f_rest, Eigen::Vector3d(0.0, 0.0, -*result.gravity), 1e-3, "force at rest");
  EXPECT_NEAR(*result.time_shift_s, 0.0, 0.05);
  EXPECT_NEAR(*result.gyro_slope, 1.0, 0.05);
  EXPECT_NEAR(*result.travel_yaw, 0.0, 2.0 * geo::kDegree);
}

TEST(Inspect, LeapSecondsAndOtherShiftsAreRecognised) {
  for (const double shift : {18.0, -18.0, 37.0}) {
    const Recording r = drive(kFrd, shift);
    const Inspection result = inspect(r.imu, r.gnss);
    EXPECT_NEAR(*result.time_shift_s, -shift, 0.06);
    EXPECT_EQ(count_of(result.events, "leap_second_shift"), 1) << shift;
  }
  const Recording r = drive(kFrd, 0.4);
  const Inspection result = inspect(r.imu, r.gnss);
  // A fix tagged t is valid at t - 0.4, which is gnss.time_offset_s as the configuration defines it.
  const std::string text = text_of(result, "time_shift");
  const std::string key = "gnss.time_offset_s: ";
  ASSERT_NE(text.find(key), std::string::npos) << text;
  EXPECT_NEAR(std::stod(text.substr(text.find(key) + key.size())), 0.4, 0.06);
}

TEST(Inspect, ProposesTheAxesThatItSees) {
  using V = Eigen::Vector3d;
  // Rows: sensor x, y, z in forward-right-down. The proposal reads: forward, right, down in terms of the sensor.
  const std::vector<std::pair<Eigen::Matrix3d, std::string>> cases = {
      {rows(V(1, 0, 0), V(0, -1, 0), V(0, 0, -1)), "axes: [x, -y, -z]"},  // forward-left-up
      {rows(V(-1, 0, 0), V(0, 1, 0), V(0, 0, -1)), "axes: [-x, y, -z]"},  // backward-right-up
      {rows(V(0, 1, 0), V(1, 0, 0), V(0, 0, -1)), "axes: [y, x, -z]"},    // right-forward-up
      {rows(V(0, 0, 1), V(1, 0, 0), V(0, 1, 0)), "axes: [y, z, x]"},      // down-forward-right
      {rows(V(0, 1, 0), V(-1, 0, 0), V(0, 0, 1)), "axes: [-y, x, z]"}};   // right-backward-down
  for (const auto& [C, proposal] : cases) {
    ASSERT_NEAR(C.determinant(), 1.0, 1e-12);
    const Recording r = drive(C, 0.0);
    const Inspection result = inspect(r.imu, r.gnss);
    ASSERT_EQ(result.events.size(), 1U) << proposal;
    EXPECT_NE(result.events[0].text.find(proposal), std::string::npos) << result.events[0].text;
  }
}

TEST(Inspect, UnitsAndSignsOfGyroAndAccelerometer) {
  const auto look = [](double gyro, double force) {
    const Recording r = drive(kFrd, 0.0, gyro, force);
    return inspect(r.imu, r.gnss);
  };
  EXPECT_NE(text_of(look(1.0 / geo::kDegree, 1.0), "gyro_unit"), "");
  EXPECT_NE(text_of(look(-1.0, 1.0), "gyro_sign"), "");
  EXPECT_NE(text_of(look(1.0, 1.0 / geo::kStandardGravity), "specific_force_unit").find("units: {accel: g}"),
            std::string::npos);
  EXPECT_NE(text_of(look(1.0, 0.01), "specific_force_unit").find("values: increments"), std::string::npos);
  EXPECT_NE(text_of(look(1.0, 100.0), "specific_force_unit").find("values: rates"), std::string::npos);
  EXPECT_NE(text_of(look(1.0, 1.03), "specific_force_size"), "");
  EXPECT_EQ(text_of(look(1.0, 1.01), "specific_force_size"), "");
}

TEST(Inspect, SaysWhereNothingOverlapsAndWhatRepeats) {
  Recording r = drive(kFrd, 0.0);
  for (auto& fix : r.gnss.fixes) fix.t = fix.t + 604800.0;
  EXPECT_EQ(count_of(inspect(r.imu, r.gnss).events, "no_overlap"), 1);
  r = drive(kFrd, 0.0);
  for (std::size_t i = 3001; i < 9000; i += 2) {
    r.imu.samples[i].dtheta = r.imu.samples[i - 1].dtheta;
    r.imu.samples[i].dv = r.imu.samples[i - 1].dv;
  }
  const Inspection result = inspect(r.imu, r.gnss);
  EXPECT_GE(result.repeated_samples, 3000);
  EXPECT_EQ(count_of(result.events, "imu_repeated_samples"), 1);
}

TEST(Inspect, ImuAlone) {
  const Recording r = drive(kFrd, 0.0);
  const Inspection result = inspect(r.imu);
  EXPECT_FALSE(result.rest_seen);
  EXPECT_NEAR(result.f_rest->z(), -9.81, 0.05);
  EXPECT_GE(result.sentences.size(), 2U);
}

}  // namespace
}  // namespace coast::io
