// Real recordings, read as they were published. Expected figures: their descriptions (counts, rates, spans, signs).

#include <gtest/gtest.h>

#include "coast/io/inspect.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using test::count_of;

class Recordings : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: no recordings here";
  }
  static record::ImuRecording imu(const std::string& keys, std::optional<geo::GpsTime> near = std::nullopt) {
    return read_imu(ImuFileOptions::from(node(keys)), near);
  }
  static record::GnssRecording gnss(const std::string& keys) { return read_gnss(GnssFileOptions::from(node(keys))); }
  static config::Node node(const std::string& keys) { return parse_yaml("{" + keys + "}\n", "run.yaml"); }
  static Eigen::Vector3d mean_force(const record::ImuRecording& imu) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double time = 0.0;
    for (const auto& s : imu.samples) {
      sum += s.dv;
      time += s.dt;
    }
    return sum / time;
  }
};

TEST_F(Recordings, CarDrive) {
  const auto fixes = gnss("file: '${COAST_DATA}/car-drive-0708/gnss_1934_sf.pos', height: msl");
  ASSERT_EQ(fixes.fixes.size(), 2197U);
  const auto fixed = std::count_if(fixes.fixes.begin(), fixes.fixes.end(),
                                   [](const auto& f) { return f.quality == record::FixQuality::kFixed; });
  EXPECT_EQ(fixed, 2189);
  EXPECT_EQ(fixes.fixes[0].t, geo::GpsTime::from_calendar({2025, 7, 8, 19, 34, 18.499}));
  const auto converted =
      imu("file: '${COAST_DATA}/car-drive-0708/imu_gpst.csv.gz', columns: {time: 1, accel: [2, 3, 4], gyro: [5, 6, 7]}",
          fixes.fixes[0].t);
  const auto original =
      imu("file: '${COAST_DATA}/car-drive-0708/imu_1934.csv.gz', columns: {time: 7, accel: [1, 2, 3], gyro: [4, 5, 6]}, "
          "units: {accel: g, gyro: deg/s}, time: {kind: elapsed, unit: ms, offset_s: 242999.948}",
          fixes.fixes[0].t);
  ASSERT_EQ(converted.samples.size(), 54860U);
  ASSERT_EQ(original.samples.size(), 54860U);
  EXPECT_NEAR(converted.rate_hz, 100.0, 1e-6);
  for (std::size_t i = 0; i < 54860; i += 1000) {
    EXPECT_EQ(converted.samples[i].t, original.samples[i].t);
    // The conversion printed five to seven digits.
    EXPECT_LT((converted.samples[i].dv - original.samples[i].dv).norm(), 1e-7);
    EXPECT_LT((converted.samples[i].dtheta - original.samples[i].dtheta).norm(), 1e-9);
  }
  const Inspection seen = inspect(converted, fixes);
  EXPECT_EQ(seen.repeated_samples, 1138);
  EXPECT_NEAR(*seen.time_shift_s, -0.02, 0.05);
  ASSERT_EQ(count_of(seen.events, "gravity_sign"), 1);
  EXPECT_NE(seen.events[0].text.find("axes: [-x, y, -z]"), std::string::npos) << seen.events[0].text;
}

TEST_F(Recordings, RcRoverOneOfFiveImus) {
  const auto fixes = gnss(
      "file: '${COAST_DATA}/rc-rover-mimu/l_rtk.csv.gz', gps_week: 2300, columns: {time: time_s, position: [north_m, east_m, "
      "down_m]}, "
      "frame: ned, origin_deg_m: [32.8, 35, 200], sd_m: [0.03, 0.03, 0.05]");
  const auto second =
      imu("file: '${COAST_DATA}/rc-rover-mimu/l_imu.csv.gz', columns: {time: time_s, accel: [imu2_ax, imu2_ay, imu2_az], "
          "gyro: [imu2_gx, imu2_gy, imu2_gz]}, units: {gyro: deg/s}",
          fixes.fixes[0].t);
  EXPECT_EQ(second.samples.size(), fixes.fixes.size() * 12);
  EXPECT_NEAR(mean_force(second).z(), -10.25, 0.1);
  const Inspection seen = inspect(second, fixes);
  EXPECT_NEAR(*seen.time_shift_s, 0.20, 0.06);
  EXPECT_GT(*seen.gyro_slope, 0.8);
}

TEST_F(Recordings, QuadrotorWithACorruptRow) {
  const auto log = gnss(
      "file: '${COAST_DATA}/quadrotor-mimu/Jul-7th-2022-11-10AM-Flight-Airdata.csv.gz', gps_week: 2217, "
      "columns: {time: time(millisecond), position: [latitude, longitude, altitude_above_seaLevel(meters)], "
      "velocity: [xSpeed(m/s), ySpeed(m/s), zSpeed(m/s)], satellites: satellites}, sd_m: [0.3, 0.3, 0.3], "
      "velocity_sd_mps: [0.1, 0.1, 0.1], height: msl, time: {kind: elapsed, unit: ms, offset_s: 374000}");
  EXPECT_EQ(log.fixes.size(), 9773U);
  const auto dot =
      imu("file: '${COAST_DATA}/quadrotor-mimu/Xsens_DOT7_D422CD004217_20220707_111437.csv.gz', "
          "columns: {time: SampleTimeFine, accel: [Acc_X, Acc_Y, Acc_Z], gyro: [Gyr_X, Gyr_Y, Gyr_Z]}, units: {gyro: deg/s}, "
          "time: {kind: elapsed, unit: us, offset_s: 373502.87}",
          log.fixes[0].t);
  EXPECT_NEAR(dot.rate_hz, 120.0, 0.01);
  for (const char* kind : {"imu_zero_row", "nan_row", "imu_gap"}) EXPECT_EQ(count_of(dot.events, kind), 1) << kind;
  EXPECT_GT(mean_force(dot).z(), 8.5);
  EXPECT_NEAR(dot.samples[0].t - log.fixes[0].t, 180.4, 0.2);
}

TEST_F(Recordings, RoverWithQuaternionReference) {
  const auto gps = gnss(
      "file: '${COAST_DATA}/rover-cpet-run3/gps-latlong.txt.gz', columns: {time: 1, position: [2, 3, 4]}, "
      "sd_m: [2, 2, 4], time: {kind: unix}");
  EXPECT_EQ(gps.fixes.size(), 7344U);
  const auto rover =
      imu("file: '${COAST_DATA}/rover-cpet-run3/imu.csv.gz', columns: {time: 1, accel: [2, 3, 4], gyro: [5, 6, 7]}, "
          "time: {kind: unix, offset_s: 1536097406.6}");
  EXPECT_EQ(rover.samples.size(), 73453U);
  EXPECT_NEAR(rover.rate_hz, 200.0, 0.01);
  const auto reference = read_reference(ReferenceFileOptions::from(
      node("file: '${COAST_DATA}/rover-cpet-run3/global-pose-utm.txt.gz', columns: {time: 1, position: [2, 3, 4], "
           "quaternion: [5, 6, 7, 8]}, attitude_to: enu, body_axes: flu, frame: utm, utm_zone: 18N, time: {kind: unix}")));
  ASSERT_EQ(reference.states.size(), 800U);
  EXPECT_TRUE(reference.has_attitude);
  EXPECT_LT((reference.states[0].r_eb_e - gps.fixes[100].r_ea_e).norm(), 40.0);  // the test ground is 32 m x 23 m
}

TEST_F(Recordings, RawCounts) {
  const auto adis =
      imu("file: '${COAST_DATA}/adis16405-static/adis16405_run1.i16.gz', format: binary, binary: {type: i16, row: 6}, "
          "columns: {gyro: [1, 2, 3], accel: [4, 5, 6]}, units: {gyro: deg/s, accel: g}, scale: {gyro: 0.05, accel: 0.00333}, "
          "time: {kind: row, rate_hz: 100}, gps_week: 1600");
  EXPECT_EQ(adis.samples.size(), 1000000U);
  EXPECT_NEAR(mean_force(adis).z() / 9.80665, -1.0175, 0.0015);
}

TEST_F(Recordings, StaticArrayWithTrailingCommas) {
  const auto dot =
      imu("file: '${COAST_DATA}/xsens-dot-static-array-a/x_stat_1.csv.gz', columns: {time: Time, accel: [f_x, f_y, f_z], gyro: "
          "[w_x, w_y, w_z]}, "
          "units: {gyro: deg/s}, gps_week: 2200");
  EXPECT_EQ(count_of(dot.events, "nan_row"), 1);
  EXPECT_NEAR(mean_force(dot).norm(), 10.0, 0.2);
  const Inspection seen = inspect(dot);
  EXPECT_GE(seen.sentences.size(), 2U);
}

}  // namespace
}  // namespace coast::io
