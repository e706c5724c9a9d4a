// The alignment on real recordings, where something independent says what it should find. Skipped without COAST_DATA.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/alignment.hpp"
#include "coast/ins/mounting.hpp"
#include "coast/io/gnss.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/yaml.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using geo::kDegree;

struct Recording {
  record::ImuRecording imu;  // body axes
  record::GnssRecording gnss;
};

Recording read(const std::string& yaml) {
  const config::Node root = io::parse_yaml(yaml, "test.yaml");
  Recording recording;
  recording.gnss = io::read_gnss(io::GnssFileOptions::from(root.at("gnss")));
  recording.imu = io::read_imu(io::ImuFileOptions::from(root.at("imu")), recording.gnss.fixes.front().t);
  ins::to_body(recording.imu, ins::C_s_b(ins::MountingOptions::from(root.at("imu"))));
  return recording;
}

void start_after(record::ImuRecording& imu, double seconds) {
  const geo::GpsTime start = imu.samples.front().t + seconds;
  const auto first =
      std::find_if(imu.samples.begin(), imu.samples.end(), [&](const auto& sample) { return sample.t >= start; });
  imu.samples.erase(imu.samples.begin(), first);
}

// Consumer grade: 0.5 deg/sqrt(h), biases of 0.3 deg/s (1 deg/s where not calibrated) and 0.2 m/s^2.
ins::InitialState align(const Recording& recording, double gyro_bias_sd) {
  return ins::align({recording.imu, recording.gnss, Eigen::Vector3d::Zero(), 1.5e-4, gyro_bias_sd, 0.2}, false);
}

geo::Euler euler_n(const record::NavState& nav) {
  const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e)).transpose();
  return geo::euler_from_dcm(C_e_n * nav.q_b_e.toRotationMatrix());
}

double course(const record::NavState& nav) {
  const Eigen::Vector3d v_n = geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e)).transpose() * nav.v_eb_e;
  return std::atan2(v_n.y(), v_n.x());
}

Recording car() {
  return read(R"(
imu: {file: "${COAST_DATA}/car-drive-0708/imu_gpst.csv.gz", format: csv, gps_week: 2374, axes: [-x, y, -z],
      columns: {time: 1, accel: [2, 3, 4], gyro: [5, 6, 7]}, units: {gyro: rad/s, accel: m/s^2}}
gnss: {file: "${COAST_DATA}/car-drive-0708/gnss_1934_sf.pos", format: rtklib-pos, height: msl}
)");
}

class AlignmentOfRecording : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set";
  }
};

TEST_F(AlignmentOfRecording, CarStandsWithItsEngineShakingThenDrives) {
  const Recording recording = car();
  const auto& samples = recording.imu.samples;
  const auto periods = ins::find_static_periods(recording.imu, &recording.gnss);
  const auto standing_at = [&](double seconds) {
    const geo::GpsTime t = samples.front().t + seconds;
    return std::any_of(periods.begin(), periods.end(),
                       [&](const auto& p) { return samples[p.first].t <= t && t <= samples[p.last].t; });
  };
  for (double seconds : {1.0, 10.0, 30.0, 200.0, 535.0, 545.0}) EXPECT_TRUE(standing_at(seconds)) << seconds;
  for (double seconds : {50.0, 100.0, 150.0, 300.0, 400.0, 500.0}) EXPECT_FALSE(standing_at(seconds)) << seconds;

  const ins::InitialState state = align(recording, 0.005);
  EXPECT_NEAR(euler_n(state.nav).pitch / kDegree, -6.79,
              3.0 * state.sd_attitude_n.x() / kDegree);  // published mounting, on level ground
  EXPECT_LT(state.sd_attitude_n.z(), 2.0 * kDegree);
  // Static gyro bias of the recording's description, (0.0, -0.06, +0.17) deg/s in sensor axes, given to 0.01.
  EXPECT_LT((state.gyro_bias / kDegree - Eigen::Vector3d(0.0, -0.06, -0.17)).norm(), 0.02);
}

TEST_F(AlignmentOfRecording, DrivingCarIsYawedAgainstItsCourseByItsMounting) {
  for (double seconds : {50.0, 100.0, 300.0}) {
    Recording recording = car();
    start_after(recording.imu, seconds);
    const ins::InitialState state = align(recording, 0.005);
    const double against_course = geo::wrap_angle(euler_n(state.nav).yaw - course(state.nav)) / kDegree;
    EXPECT_NEAR(against_course, 5.35, 3.0) << state.method;  // published mounting; three stated sigma, sideslip within that
    EXPECT_LT(state.sd_attitude_n.z(), 2.0 * kDegree) << state.method;
  }
}

TEST_F(AlignmentOfRecording, VibratingRoverThatMovesFromItsFirstRow) {
  for (const char* k : {"1", "2", "4"}) {
    const std::string imu = std::string("imu") + k;
    Recording recording = read(
        "imu: {file: \"${COAST_DATA}/rc-rover-mimu/k_imu.csv.gz\", format: csv, gps_week: 2300, columns: {time: time_s, accel: "
        "[" +
        imu + "_ax, " + imu + "_ay, " + imu + "_az], gyro: [" + imu + "_gx, " + imu + "_gy, " + imu +
        "_gz]}, units: {gyro: deg/s, accel: m/s^2}}\n"
        "gnss: {file: \"${COAST_DATA}/rc-rover-mimu/k_rtk.csv.gz\", format: csv, gps_week: 2300, columns: {time: time_s, "
        "position: "
        "[north_m, east_m, down_m]}, frame: ned, origin_deg_m: [32.8, 35.0, 100.0], sd_m: [0.02, 0.02, 0.03]}\n");
    start_after(recording.imu, 40.0);
    const ins::InitialState state = align(recording, 0.02);
    // Sensors nominally x forward: course, with the clock's 0.05 s at 40 deg/s, sideslip of a snaking car, and 3 sigma of 3
    // deg.
    EXPECT_NEAR(geo::wrap_angle(euler_n(state.nav).yaw - course(state.nav)) / kDegree, 0.0, 12.0)
        << imu << ", " << state.method;
    EXPECT_LT(state.sd_attitude_n.z(), 5.0 * kDegree);
  }
}

TEST_F(AlignmentOfRecording, QuadrotorFindsTheHeadingOfItsCompass) {
  Recording recording = read(R"(
imu: {file: "${COAST_DATA}/quadrotor-mimu/Xsens_DOT1_D422CD003EBC_20220707_111438.csv.gz", format: csv, gps_week: 2217, axes: [x, -y, -z],
      columns: {time: SampleTimeFine, accel: [Acc_X, Acc_Y, Acc_Z], gyro: [Gyr_X, Gyr_Y, Gyr_Z]}, units: {accel: m/s^2, gyro: deg/s},
      time: {kind: elapsed, unit: us, offset_s: 374545.77}}
gnss: {file: "${COAST_DATA}/quadrotor-mimu/Jul-7th-2022-11-10AM-Flight-Airdata.csv.gz", format: csv, gps_week: 2217, height: msl,
       columns: {time: 1, position: [3, 4, 8], velocity: [20, 21, 22]}, time: {kind: elapsed, unit: ms, offset_s: 375042.9},
       sd_m: [0.03, 0.03, 0.1], velocity_sd_mps: [0.1, 0.1, 0.1]}
)");
  const ins::InitialState state = align(recording, 0.02);
  // The flight log's compass says 247.6 deg at that time; a compass and the IMU's mounting are each good to some degrees.
  EXPECT_NEAR(geo::wrap_angle(euler_n(state.nav).yaw - 247.6 * kDegree) / kDegree, 0.0, 6.0) << state.method;
}

}  // namespace
}  // namespace coast
