// What `coast inspect` says of files of known content.

#include "coast/jobs/inspect.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "io/navigation_messages.hpp"
#include "io/ubx_messages.hpp"
#include "support/support.hpp"

namespace coast::jobs {
namespace {

using test::nav_pvt;
using test::Pvt;
using test::rawx;
using test::RawxSignal;

class Inspect : public testing::Test {
 protected:
  std::string text_of(const std::string& name, const std::string& content, std::optional<int> gps_week = std::nullopt) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
    const InspectConfig config{folder_.path() / name, gps_week};
    return told(config, inspect(config, {}));
  }
  static void expect_lines(const std::string& text, const std::vector<std::string>& lines) {
    for (const std::string& line : lines) EXPECT_NE(text.find(line), std::string::npos) << line << "\nis not in\n" << text;
  }
  test::TemporaryDirectory folder_;
};

TEST_F(Inspect, UbxNamesMessagesSignalsGapsAndWhatIsNotThere) {
  std::string content = test::nmea("GNGGA,,,,,,0");
  for (const int t : {0, 1, 2, 7, 8}) {
    RawxSignal gps, galileo;
    galileo.gnss = 2;
    galileo.sv = 11;
    galileo.tracking = 3;
    galileo.cn0 = 40;
    content += rawx(2244, 36000.0 + t, {gps, galileo});
    Pvt p;
    p.tow_ms += static_cast<unsigned>(1000 * t);
    p.second += static_cast<unsigned>(t);
    content += nav_pvt(p);
  }
  std::string damaged = nav_pvt({});
  damaged[30] = 'x';
  const std::string text = text_of("rover.ubx", content + damaged);
  expect_lines(
      text, {"rover.ubx: UBX of u-blox receivers", "       5 UBX-RXM-RAWX", "       1 NMEA GGA",
             "5 epochs, 2023-01-08 10:00:00.000 GPST to 2023-01-08 10:00:08.000 GPST, one every 1 s; 1 gap, the longest 5.00 s",
             "2 to 2 satellites at a time",
             "GPS      1C:   1 satellites,       5 codes,       5 phases, losses of lock     1, mean C/N0 45.0 dBHz",
             "5 with half cycles unknown", "GNSS: 5 fixes over 8.00 s", "100.0 % fixed", "with a wrong checksum", "not found",
             "without UBX-RXM-SFRBX", "without UBX-ESF-RAW"});
  // Each reader sees the damage; it is told once.
  EXPECT_EQ(text.find("wrong checksum"), text.rfind("wrong checksum")) << text;
}

TEST_F(Inspect, NavigationMessagesHaveTheirSystemsAndHealth) {
  test::BitString one, two, three;
  one.put(2244 % 1024, 10).put(1, 2).put(2, 4).put(5, 6).put(0, 2).put(0, 88).put(0, 8).put(7, 8).put(2250, 16);
  one.put(0, 8).put(0, 16).put(0, 22).put(0, 2);
  two.put(7, 8)
      .put(0, 16)
      .put(0, 16)
      .put(0, 32)
      .put(0, 16)
      .put(1000, 32)
      .put(0, 16)
      .put(2'701'999'513, 32)
      .put(2250, 16)
      .put(0, 8);
  three.put(0, 16).put(0, 32).put(0, 16).put(0, 32).put(0, 16).put(0, 32).put(0, 24).put(7, 8).put(0, 14).put(0, 2);
  std::string content = rawx(2244, 36000.0, {});
  int number = 0;
  for (const auto& bits : {one, two, three})
    content += test::sfrbx(0, 7, 0, 0, test::lnav_subframe(++number, bits, test::LnavForm::kWordInverted));
  expect_lines(text_of("nav.ubx", content), {"GPS        1 satellites,     1 ephemerides, 2023-01-08 10:00:00.000 GPST",
                                             "not healthy: G07", "no ionosphere model"});
}

TEST_F(Inspect, TablesAndTrajectoriesAreRecognised) {
  std::string imu = "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n", nav;
  for (int i = 0; i < 50; ++i) {
    imu += fmt::format("{:.2f},0.001,0.002,{:.4f},0.1,0.2,-9.8\n", 100.0 + 0.01 * i, 0.0001 * i);
    nav += fmt::format("2374 {:.2f} 40.1 -105.1 1600 1 2 3 0.1 0.2 30\n", 100.0 + 0.01 * i);
  }
  expect_lines(text_of("imu.csv", imu, 2374), {"IMU: 50 samples over 0.49 s at 100.00 Hz"});
  EXPECT_THROW(static_cast<void>(text_of("imu.csv", imu)), InputError);
  expect_lines(text_of("a.nav", nav), {"trajectory", "50 epochs", "with velocity, with attitude"});
}

TEST_F(Inspect, RinexIsRecognised) {
  const std::string observations =
      "     3.04           OBSERVATION DATA    G: GPS              RINEX VERSION / TYPE\n"
      "BASE                                                        MARKER NAME         \n"
      "G    2 C1C L1C                                              SYS / # / OBS TYPES \n"
      "                                                            END OF HEADER       \n"
      "> 2023 01 08 10 00 00.0000000  0  1\n"
      "G05  21000000.125   110000000.2501 \n";
  expect_lines(text_of("base.obs", observations), {"RINEX", "marker BASE", "1 epochs", "GPS      1C:   1 satellites"});
}

TEST_F(Inspect, RunFilesAreReadWithTheirColumnsAxesAndUnits) {
  std::string imu, positions = "t,lat,lon,h\n";
  for (int n = 0; n < 3000; ++n)  // forward, left, up in g and deg/s
    imu += fmt::format("{:.2f} 0.01 0.0 {:.4f} 0.001 0.0 1.0\n", 1000.0 + 0.01 * n, 1e-4 * (n % 7));
  for (int n = 0; n < 30; ++n) positions += fmt::format("{}.0,47.0,8.0,500.{:03}\n", 1000 + n, n % 3);
  std::ofstream(folder_.path() / "imu.txt") << imu;
  std::ofstream(folder_.path() / "positions.csv") << positions;
  const std::string text = text_of("run.yaml", R"(
imu:
  file: imu.txt
  gps_week: 2374
  columns: {time: 1, gyro: [2, 3, 4], accel: [5, 6, 7]}
  units: {gyro: deg/s, accel: g}
  axes: [x, -y, -z]
  error_model: )" COAST_SOURCE_DIR R"(/configs/imu/adis16465.yaml
  lever_arm_m: [0, 0, 0]
gnss: {file: positions.csv, gps_week: 2374, columns: {time: t, position: [lat, lon, h]}, sd_m: [0.02, 0.02, 0.04]}
)");
  expect_lines(text, {"run.yaml: a run file", "as `coast process` reads them", "IMU: 3000 samples", "GNSS: 30 fixes"});
  EXPECT_THROW(static_cast<void>(text_of("study.yaml", "run: run.yaml\n")), InputError);
}

TEST_F(Inspect, AnythingElseIsRefused) {
  for (const char* content : {"Dear reader\nthis is no recording\n", "PK\x03\x04zip", "imu: {file: a.csv}\n"})
    EXPECT_THROW(static_cast<void>(text_of("other.txt", content)), InputError) << content;
  EXPECT_THROW(static_cast<void>(inspect({folder_.path() / "missing", {}}, {})), InputError);
}

TEST_F(Inspect, AsksForAWeekOnlyWhereThatIsAllThatLacks) {
  std::string rows = "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n";
  for (int n = 0; n < 100; ++n) rows += fmt::format("{:.2f},0.001,0.002,{},0.1,0.2,-9.8\n", 1000.0 + 0.01 * n, 1e-4 * n);
  const auto refused = [&](const std::string& content) -> std::string {
    try {
      return text_of("imu.csv", content);
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const std::string asked = refused(rows);
  expect_lines(asked, {"seconds of week without a GPS week", "--gps-week"});
  EXPECT_EQ(asked.find("imu.csv"), asked.rfind("imu.csv")) << asked;
  expect_lines(text_of("imu.csv", rows, 2374), {"IMU: 100 samples"});
  const std::string other = refused("# Notes\n\nIt rained.\n");
  EXPECT_EQ(other.find("--gps-week"), std::string::npos) << other;
}

}  // namespace
}  // namespace coast::jobs
