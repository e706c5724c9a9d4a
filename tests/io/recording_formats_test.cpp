// What `coast convert` writes of a receiver's own file, read again: the numbers of the file itself, to the printed digits.

#include "coast/io/recording_formats.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "coast/geo/units.hpp"
#include "coast/io/rinex.hpp"
#include "io/files.hpp"
#include "io/ubx_messages.hpp"

namespace coast::io {
namespace {

using test::Files;

const RecordingFormat& recording_format(std::string_view name) {
  return *std::ranges::find(recording_formats(), name, &RecordingFormat::name);
}

/// Writes every part that the file has, as log.<extension>; returns their names.
std::vector<std::string> convert_all(const Files& files, std::string_view format, const FileContents& contents) {
  std::vector<std::string> written;
  for (const RecordingPart& part : recording_format(format).parts) {
    if (!part.present(contents)) continue;
    written.push_back("log." + std::string(part.extension));
    part.write(files.path(written.back()), contents, nullptr);
  }
  return written;
}

/// Twenty seconds of 1 Hz positions, with rates and specific forces at 10 Hz between them and one edge.
std::string log_with_everything() {
  std::string log;
  for (unsigned i = 0; i < 20; ++i) {
    test::Pvt pvt;
    pvt.tow_ms += 1000 * i;
    pvt.second += i;
    pvt.minute += pvt.second / 60;
    pvt.hour += pvt.minute / 60;
    pvt.minute %= 60;
    pvt.second %= 60;
    pvt.lon += static_cast<int>(17 * i);
    log += test::nav_pvt(pvt);
    for (unsigned k = 0; k < 10; ++k)
      log += test::esf_meas(1000 * i + 100 * k, {{14, 4096 * static_cast<int>(k)},
                                                 {13, -7},
                                                 {5, 3},
                                                 {16, 100},
                                                 {17, -200},
                                                 {18, 10000 + static_cast<int>(i)},
                                                 {12, 2150}});
    log += test::rawx(2244, 36'000.0 + i, {{.sv = 5, .phase = 110'000'000.25 + i}, {.gnss = 2, .sv = 7, .lock_ms = 0}});
  }
  return log;
}

TEST(RecordingFormats, CsvOfImuAndPositionsIsReadWithoutColumns) {
  const Files files;
  files.put("log.ubx", log_with_everything());
  const FileContents contents = read_contents(files.path("log.ubx"));
  EXPECT_EQ(convert_all(files, "csv", contents), (std::vector<std::string>{"log.imu.csv", "log.gnss.csv"}));
  const record::ImuRecording imu = files.imu("log.imu.csv");
  ASSERT_EQ(imu.samples.size(), contents.imu->samples.size());
  for (std::size_t i = 1; i < imu.samples.size(); ++i) {
    const record::ImuSample &read = imu.samples[i], &own = contents.imu->samples[i];
    EXPECT_NEAR(read.t - own.t, 0.0, 1e-9);
    EXPECT_LT((read.dtheta / read.dt - own.dtheta / own.dt).norm(), 1e-12);
    EXPECT_LT((read.dv / read.dt - own.dv / own.dt).norm(), 1e-11);
  }
  EXPECT_EQ(imu.temperature, contents.imu->temperature);
  const record::GnssRecording gnss = files.gnss("log.gnss.csv");
  ASSERT_EQ(gnss.fixes.size(), 20U);
  for (std::size_t i = 0; i < gnss.fixes.size(); ++i) {
    const record::GnssFix &read = gnss.fixes[i], &own = contents.gnss->fixes[i];
    EXPECT_NEAR(read.t - own.t, 0.0, 1e-9);
    EXPECT_LT((read.r_ea_e - own.r_ea_e).norm(), 2e-4);  // 1e-9 deg and 0.1 mm
    EXPECT_LT((read.position_cov_n.diagonal() - own.position_cov_n.diagonal()).norm(), 1e-6);
    EXPECT_LT((read.velocity->v_ea_n - own.velocity->v_ea_n).norm(), 1e-6);
    EXPECT_EQ(read.quality, record::FixQuality::kFixed);
    EXPECT_EQ(read.satellites, 17);
  }
}

TEST(RecordingFormats, RinexAndPosOfTheSameLog) {
  const Files files;
  files.put("log.ubx", log_with_everything());
  const FileContents contents = read_contents(files.path("log.ubx"));
  EXPECT_EQ(convert_all(files, "rinex", contents), std::vector<std::string>{"log.obs"});
  const record::ObservationRecording rinex = read_observations(files.path("log.obs"));
  ASSERT_EQ(rinex.epochs.size(), contents.observations->epochs.size());
  for (std::size_t i = 0; i < rinex.epochs.size(); ++i) {
    const auto &read = rinex.epochs[i].observations, &own = contents.observations->epochs[i].observations;
    ASSERT_EQ(read.size(), own.size());
    for (std::size_t k = 0; k < read.size(); ++k) {
      EXPECT_EQ(read[k].satellite, own[k].satellite);
      EXPECT_EQ(read[k].signal, own[k].signal);
      EXPECT_NEAR(read[k].code_m.value(), own[k].code_m.value(), 0.5001e-3);
      EXPECT_NEAR(read[k].phase_cycles.value(), own[k].phase_cycles.value(), 0.5001e-3);
      EXPECT_EQ(read[k].lost_lock, own[k].lost_lock);
    }
  }
  EXPECT_EQ(convert_all(files, "pos", contents), std::vector<std::string>{"log.pos"});
  EXPECT_EQ(files.gnss("log.pos").fixes.size(), 20U);
}

TEST(RecordingFormats, TimeMarksKeepEdgeAndName) {
  const Files files;
  FileContents contents;
  const geo::GpsTime t = geo::GpsTime::from_week(2244, 36'000.123'456'789);
  contents.marks = record::TimeMarkRecording{"log", {{t, 2e-8, 1, record::Edge::kRising, 7}, {t + 1.0}}, {}};
  contents.marks->marks[1].id = "a, \"b\"";
  EXPECT_EQ(convert_all(files, "csv", contents), std::vector<std::string>{"log.marks.csv"});
  EXPECT_EQ(files.get("log.marks.csv"),
            "gps_week,sow_s,sd_s,channel,edge,count,id\n"
            "2244,36000.123456789,0.000000020,1,rising,7,\n"
            "2244,36001.123456789,,0,,0,\"a, \"\"b\"\"\"\n");
  const record::TimeMarkRecording marks = files.events("log.marks.csv");
  ASSERT_EQ(marks.marks.size(), 2U);
  EXPECT_NEAR(marks.marks[0].t - t, 0.0, 1e-9);
}

TEST(RecordingFormats, PositionsWithoutAllVelocitiesHaveNone) {
  const Files files;
  FileContents contents;
  record::GnssFix fix;
  fix.t = geo::GpsTime::from_week(2244, 36'000.0);
  fix.r_ea_e = geo::ecef_from_geodetic({0.8, 0.1, 300.0});
  fix.position_cov_n = Eigen::Vector3d(1e-4, 1e-4, 4e-4).asDiagonal();
  contents.gnss = record::GnssRecording{"log", {fix, fix}, {}};
  contents.gnss->fixes[1].t = fix.t + 1.0;
  contents.gnss->fixes[1].velocity = {Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Matrix3d::Identity()};
  (void)convert_all(files, "csv", contents);
  const record::GnssRecording gnss = files.gnss("log.gnss.csv");
  ASSERT_EQ(gnss.fixes.size(), 2U);
  EXPECT_FALSE(gnss.fixes[1].velocity.has_value());
  EXPECT_FALSE(gnss.fixes[1].satellites.has_value());
  EXPECT_NEAR(gnss.fixes[0].position_cov_n(2, 2), 4e-4, 1e-9);
}

}  // namespace
}  // namespace coast::io
