// Spoiled inputs: each is refused with an InputError that names the file and, where there is one, the line.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>

#include "files.hpp"
#include "novatel_messages.hpp"
#include "receiver_messages.hpp"
#include "sbf_messages.hpp"

namespace coast::io {
namespace {

using test::Files;
using test::refusal;

enum class Kind { kImu, kGnss, kReference, kEvents };

/// What is read, from what text, and what the message must contain ("%" stands for the file's name).
struct Spoiled {
  const char* what;
  Kind kind;
  std::string content;
  std::string keys;
  std::string message;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const std::string kImuHeader = "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n";

std::string imu_rows(int n, double start = 100.0) {
  std::string text;
  for (int i = 0; i < n; ++i) text += fmt::format("{:.2f},0.001,0.002,0.003,0.1,0.2,-9.8\n", start + 0.01 * i);
  return text;
}
std::string imu_csv() {
  return kImuHeader + imu_rows(30);
}

/// Line `line` (1-based) replaced.
std::string with_line(const std::string& text, int line, const std::string& content) {
  std::size_t begin = 0;
  for (int i = 1; i < line; ++i) begin = text.find('\n', begin) + 1;
  return text.substr(0, begin) + content + text.substr(text.find('\n', begin));
}

const std::string kPosHeader =
    "%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) sdeu(m) sdun(m) age(s) ratio\n";
std::string pos_rows(int n) {
  std::string text;
  for (int i = 0; i < n; ++i)
    text += fmt::format("2025/07/08 19:34:{:06.3f} 40.1 -105.1 1600.0 1 20 0.01 0.01 0.02 0 0 0 0 0\n", 0.25 * i);
  return text;
}
std::string pos() {
  return kPosHeader + pos_rows(30);
}

std::string nav_rows(int n) {
  std::string text;
  for (int i = 0; i < n; ++i) text += fmt::format("2374 {:.2f} 40.1 -105.1 1600 1 2 3 0.1 0.2 30\n", 100.0 + 0.01 * i);
  return text;
}

const std::string kWeek = "gps_week: 2374";
const std::string kMapped = "columns: {time: 1, gyro: [2, 3, 4], accel: [5, 6, 7]}, gps_week: 2374";
const std::string kGnssMapped = "columns: {time: 1, position: [2, 3, 4]}, sd_m: [1, 1, 1], gps_week: 2374";
const std::string kPoseMapped = "columns: {time: 1, position: [2, 3, 4], quaternion: [5, 6, 7, 8]}, gps_week: 2374";

std::vector<Spoiled> imu_files() {
  const std::string csv = imu_csv();
  const std::string row = "100.05,0.001,0.002,0.003,0.1,0.2,-9.8";
  return {
      {"empty", Kind::kImu, "", kWeek, "%: the file is empty"},
      {"only a line feed", Kind::kImu, "\n", kWeek, "%:1: no row"},
      {"only blanks", Kind::kImu, "   \n\t\n  \n", kWeek, "%:3: no row"},
      {"only a header", Kind::kImu, kImuHeader, kWeek, "%:1: no row"},
      {"only comments", Kind::kImu, "# a\n% b\n", kWeek, "%:2: no row"},
      {"one row", Kind::kImu, kImuHeader + imu_rows(1), kWeek, "%: 1 IMU samples"},
      {"prose", Kind::kImu, "Dear reader\nthis is no table\n", kWeek, "%: no column named \"time_s\""},
      {"no gps_week", Kind::kImu, csv, "", "%: seconds of week without a GPS week"},
      {"two headers", Kind::kImu, kImuHeader + csv, kWeek, "%:2: \"time_s\" in column 1"},
      {"header again in the middle", Kind::kImu, kImuHeader + imu_rows(20) + csv, kWeek, "%:22: \"time_s\""},
      {"unknown header", Kind::kImu, replaced(csv, "gyro_y_radps", "gyro_y"), kWeek, "%: no column named \"gyro_y_radps\""},
      {"names beyond the columns", Kind::kImu, replaced(csv, "mps2\n", "mps2,a,b\n"), kWeek, "%:2: 7 columns"},
      {"missing field", Kind::kImu, with_line(csv, 7, "100.05,0.001,0.002,0.003,0.1,0.2"), kWeek, "%:7: 6 columns"},
      {"field too many", Kind::kImu, with_line(csv, 7, row + ",1"), kWeek, "%:7: 8 columns"},
      {"blank delimiter in a comma file", Kind::kImu, with_line(csv, 7, "100.05 0.001 0.002 0.003 0.1 0.2 -9.8"), kWeek,
       "%:7:"},
      {"word for a number", Kind::kImu, with_line(csv, 7, replaced(row, "0.003", "zero")), kWeek, "%:7: \"zero\" in column 4"},
      {"number with a tail", Kind::kImu, with_line(csv, 7, replaced(row, "0.003", "0.003x")), kWeek, "%:7: \"0.003x\""},
      {"two points", Kind::kImu, with_line(csv, 7, replaced(row, "0.003", "0.0.3")), kWeek, "%:7: \"0.0.3\""},
      {"hexadecimal", Kind::kImu, with_line(csv, 7, replaced(row, "0.003", "0x1p3")), kWeek, "%:7: \"0x1p3\""},
      {"two signs", Kind::kImu, with_line(csv, 7, replaced(row, "0.003", "+-3")), kWeek, "%:7: \"+-3\""},
      {"control characters", Kind::kImu, with_line(csv, 7, replaced(row, "0.003", "\x01\x02")), kWeek, "%:7: \"??\""},
      {"decimal commas", Kind::kImu, "1;0,1;0;0;0;0;-9,8\n2;0,1;0;0;0;0;-9,8\n", kMapped,
       "%:1: \"0,1\" in column 2, expected a number. Write decimals with a point"},
      {"unclosed quote", Kind::kImu, with_line(csv, 7, "\"" + row), kWeek, "%:7: 1 column"},
      {"time goes back", Kind::kImu, csv + imu_rows(5, 50.0), kWeek, "%:32: time goes back by 50.290 s"},
      {"two recordings", Kind::kImu, csv + imu_rows(5), kWeek, "%:32: time goes back by 0.290 s"},
      {"a stamp far ahead", Kind::kImu, with_line(csv, 7, replaced(row, "100.05", "90000.05")), kWeek,
       "%:7: time jumps ahead by 89900.010 s"},
      {"time is not finite often", Kind::kImu,
       kImuHeader + imu_rows(9) +
           [] {
             std::string s;
             for (int i = 0; i < 20; ++i) s += "nan,0,0,0,0,0,-9.8\n";
             return s;
           }(),
       kWeek, "%:11: a field that is empty or not finite"},
      {"every row twice with other values", Kind::kImu,
       kImuHeader +
           [] {
             std::string s;
             for (int i = 0; i < 30; ++i)
               for (int again = 0; again < 2; ++again)
                 s += fmt::format("{:.2f},{},0,0,0,0,-9.8\n", 100.0 + 0.01 * i, 2 * i + again);
             return s;
           }(),
       kWeek, "%:3: time repeats"},
      {"time in nanoseconds taken for seconds", Kind::kImu, "1e15,0,0,0,0,0,-9.8\n2e15,0,0,0,0,0,-9.8\n", kMapped, "%:1: time"},
      {"a gyro column of text", Kind::kImu, "1,a,0,0,0,0,-9.8\n2,b,0,0,0,0,-9.8\n", kMapped, "%:1: \"a\" in column 2"},
      {"a rate beyond physics", Kind::kImu, with_line(csv, 7, replaced(row, "0.003", "3e200")), kWeek,
       "%:7: an angular rate of 3e+200"},
      {"column beyond the table", Kind::kImu, "1,0,0,0,0,0\n2,0,0,0,0,0\n", kMapped, "%:1: 6 columns, expected column 7"},
      {"name without a header", Kind::kImu, imu_rows(5), replaced(kMapped, "2,", "gx,"), "%:1: no header line"},
  };
}

std::vector<Spoiled> binary_imu_files() {
  const std::string csv = imu_csv();
  return {
      {"zero byte in the middle", Kind::kImu, kImuHeader + imu_rows(5) + std::string(4, '\0') + imu_rows(5), kWeek,
       "%:7: binary data"},
      {"a picture", Kind::kImu, std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0", 18), kWeek, "%:"},
      {"random bytes", Kind::kImu, "\xC3\x28\xA0\xFF\xFE\x01\x10\n\x7F\x80\n", kWeek, "%:"},
      {"cut gzip", Kind::kImu, std::string("\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03\x33\xd4\x31", 13), kWeek,
       "%: the gzip data are damaged or end early"},
      {"gzip of nothing", Kind::kImu,
       std::string("\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03\x03\x00\x00\x00\x00\x00\x00\x00\x00\x00", 20), kWeek, "%"},
      {"a line without end", Kind::kImu, std::string(3 << 20, '1'), kWeek, "%:1: a line of more than 1 MiB"},
      {"unknown format", Kind::kImu, csv, "format: cvs, " + kWeek, "%: format \"cvs\" for an IMU file"},
      {"format that has no IMU", Kind::kImu, csv, "format: sbet, " + kWeek, "%: format \"sbet\" for an IMU file"},
      {"IMR without its header", Kind::kImu, "$IMURAX and so on", "format: imr, " + kWeek, "%: header: no \"$IMURAW\""},
      {"IMR cut in its header", Kind::kImu, std::string("$IMURAW\0", 8) + std::string(100, '\0'), kWeek, "%: header:"},
      {"IMR with a header alone", Kind::kImu, std::string("$IMURAW\0", 8) + std::string(504, '\0'), kWeek,
       "%: header: data rate 0"},
      {"binary without layout", Kind::kImu, std::string(120, '\1'), "format: binary, " + kWeek,
       "%: binary data without a layout"},
      {"binary with names", Kind::kImu, std::string(120, '\1'),
       "format: binary, columns: {time: 1, gyro: [a, b, c], accel: [5, 6, 7]}, " + kWeek, "%: column \"a\""},
      {"binary row too short", Kind::kImu, std::string(120, '\1'),
       "format: binary, binary: {row: 5}, time: {kind: row, rate_hz: 10}, columns: {gyro: [1, 2, 3], accel: [4, 5, 6]}, " +
           kWeek,
       "%: column 6"},
      {"binary with one record", Kind::kImu, std::string(14, '\1'),
       "format: binary, time: {kind: row, rate_hz: 10}, columns: {gyro: [1, 2, 3], accel: [4, 5, 6]}, " + kWeek,
       "%: 1 IMU samples"},
      {"binary header beyond the end", Kind::kImu, std::string(14, '\1'),
       "format: binary, binary: {header_bytes: 99}, time: {kind: row, rate_hz: 10}, columns: {gyro: [1, 2, 3], accel: [4, 5, "
       "6]}, " +
           kWeek,
       "%: 14 bytes"},
  };
}

std::vector<Spoiled> gnss_files() {
  const std::string good = pos();
  const std::string row = "2025/07/08 19:34:01.000 40.1 -105.1 1600.0 1 20 0.01 0.01 0.02 0 0 0 0 0";
  const auto with_row = [&](const std::string& from, const std::string& to) {
    return with_line(good, 6, replaced(row, from, to));
  };
  return {
      {"empty", Kind::kGnss, "", "", "%: the file is empty"},
      {"only a header", Kind::kGnss, kPosHeader, "", "%:1: no row"},
      {"sigma zero", Kind::kGnss, with_row("0.01 0.01", "0.01 0.00"), "", "%:6: position standard deviation 0"},
      {"sigma negative", Kind::kGnss, with_row("0.01 0.01", "-0.01 0.01"), "", "%:6: position standard deviation -0.01"},
      {"sigma without bound", Kind::kGnss, with_row("0.01 0.01", "1e9 0.01"), "", "%:6: position standard deviation"},
      {"covariance impossible", Kind::kGnss, with_row("0.02 0 0 0", "0.02 5 0 0"), "",
       "%:6: position covariance that is not positive definite"},
      {"latitude beyond the pole", Kind::kGnss, with_row("40.1", "90.1"), "", "%:6: latitude 90.1 deg"},
      {"longitude beyond a turn", Kind::kGnss, with_row("-105.1", "-400"), "", "%:6: longitude -400 deg"},
      {"height in millimetres", Kind::kGnss, with_row("1600.0", "16000000"), "", "%:6: height"},
      {"height of the Earth's centre", Kind::kGnss, with_row("1600.0", "-6378137"), "", "%:6: height"},
      {"month 13", Kind::kGnss, with_row("2025/07", "2025/13"), "", "%:6:"},
      {"30 February", Kind::kGnss, with_row("2025/07/08", "2025/02/30"), "", "%:6:"},
      {"hour 24", Kind::kGnss, with_row("19:34", "24:34"), "", "%:6:"},
      {"minute missing", Kind::kGnss, with_row("19:34:01.000", "19:34"), "", "%:6: time \"2025/07/08 19:34\""},
      {"date in words", Kind::kGnss, with_row("2025/07/08", "8-Jul-25"), "", "%:6: time"},
      {"date with dots reversed", Kind::kGnss, with_row("2025/07/08", "08/07/2025"), "", "%:6:"},
      {"seconds negative", Kind::kGnss, with_row("34:01.000", "34:-1.000"), "", "%:6: time"},
      {"missing field", Kind::kGnss, with_row(" 0 0 0 0 0", " 0 0 0 0"), "", "%:6: 14 columns, expected 15"},
      {"letters for a latitude", Kind::kGnss, with_row("40.1", "N40.1"), "", "%:6: \"N40.1\" in column 3"},
      {"time goes back", Kind::kGnss, good + pos_rows(3), "", "%:32: time goes back by 7.250 s"},
  };
}

std::vector<Spoiled> gnss_tables() {
  return {
      {"week not whole", Kind::kGnss, kPosHeader + "2374.5 100.0 40 5 0 1 9 1 1 1 0 0 0 0 0\n", "", "%:2: GPS week 2374.5"},
      {"week negative", Kind::kGnss, kPosHeader + "-3 100.0 40 5 0 1 9 1 1 1 0 0 0 0 0\n", "", "%:2: GPS week -3"},
      {"week and seconds in UTC", Kind::kGnss, replaced(kPosHeader, "GPST", "UTC") + "2374 100.0 40 5 0 1 9 1 1 1 0 0 0 0 0\n",
       "", "%:2: week and seconds in UTC"},
      {"no solution anywhere", Kind::kGnss, kPosHeader + "2374 100.0 0 0 0 0 0 0 0 0 0 0 0 0 0\n", "", "%: no GNSS fix"},
      {"ECEF at the centre", Kind::kGnss,
       "%  GPST x-ecef(m) y-ecef(m) z-ecef(m) Q ns sdx(m)\n2374 1 0 0 0 1 9 1 1 1 0 0 0 0 0\n", "",
       "%:2: a position 0.000 km from the Earth's centre"},
      {"baseline without base", Kind::kGnss,
       "%  GPST e-baseline(m) n-baseline(m) u-baseline(m) Q\n2374 1 0 0 0 1 9 1 1 1 0 0 0 0 0\n", "",
       "%: coordinates relative to an origin that is not stated"},
      {"columns end in the position", Kind::kGnss, kPosHeader + "2374 1 40 5\n", "",
       "%:2: 4 columns, expected column 5 (position)"},
      {"NaN in most rows", Kind::kGnss,
       kPosHeader +
           [] {
             std::string s;
             for (int i = 0; i < 40; ++i)
               s += fmt::format("2374 {} {} 5 0 1 9 1 1 1 0 0 0 0 0\n", i, i % 2 == 0 ? "nan" : "40");
             return s;
           }(),
       "", "%:2: a field that is empty or not finite"},
      {"table without sigma", Kind::kGnss, "1,40,5,0\n2,40,5,0\n", "columns: {time: 1, position: [2, 3, 4]}, gps_week: 2374",
       "%: no standard deviations"},
      {"table with a zero sigma", Kind::kGnss, "1,40,5,0,1,1,1\n2,40,5,0,1,1,0\n",
       "columns: {time: 1, position: [2, 3, 4], sd: [5, 6, 7]}, gps_week: 2374", "%:2: position standard deviation 0"},
      {"velocity without sigma", Kind::kGnss, "1,40,5,0,1,1,1\n2,40,5,0,1,1,1\n",
       "columns: {time: 1, position: [2, 3, 4], velocity: [5, 6, 7]}, sd_m: [1, 1, 1], gps_week: 2374",
       "%: velocities without standard deviations"},
      {"velocity sigma zero", Kind::kGnss, "1,40,5,0,1,1,0\n2,40,5,0,1,1,0\n",
       "columns: {time: 1, position: [2, 3, 4], velocity: [5, 6, 7], velocity_sd: [5, 6, 7]}, sd_m: [1, 1, 1], gps_week: 2374",
       "%:1: velocity standard deviation 0"},
      {"latitude and longitude swapped", Kind::kGnss, "1,-105,40,0\n", kGnssMapped, "%:1: latitude -105 deg"},
      {"UTM swapped", Kind::kGnss, "1,4833438,630084,0\n", kGnssMapped + ", frame: utm, utm_zone: 17N", "%:1: UTM easting"},
      {"local coordinates in degrees of nowhere", Kind::kGnss, "1,1e9,0,0\n",
       kGnssMapped + ", frame: ned, origin_deg_m: [40, 5, 0]", "%:1: 1000000000 m from the origin"},
      {"UTC kind on seconds", Kind::kGnss, "1,40,5,0\n", kGnssMapped + ", time: {kind: utc}", "%:1: time \"1\""},
      {"one column for week and seconds", Kind::kGnss, "1,40,5,0\n", kGnssMapped + ", time: {kind: week_sow}",
       "%: 1 time columns, expected 2"},
  };
}

std::vector<Spoiled> reference_files() {
  const std::string good = nav_rows(30);
  const std::string row = "2374 100.04 40.1 -105.1 1600 1 2 3 0.1 0.2 30";
  const std::string pose = "1 40 5 0 0 0 0 1\n2 40 5 0 0 0 0 1\n";
  const auto bytes_of = [](std::array<double, 17> record, int n, double step) {
    std::string bytes;
    for (int i = 0; i < n; ++i, record[0] += step) bytes.append(reinterpret_cast<const char*>(record.data()), sizeof(record));
    return bytes;
  };
  const std::array<double, 17> sbet{100.0, 0.7, 0.1, 50.0};
  auto outside = sbet;
  outside[1] = 2.0;
  return {
      {"empty", Kind::kReference, "", "", "%: the file is empty"},
      {"nav with a word", Kind::kReference, with_line(good, 5, replaced(row, "-105.1", "west")), "",
       "%:5: \"west\" in column 4"},
      {"nav with ten columns", Kind::kReference, with_line(good, 5, replaced(row, " 30", "")), "", "%:5: 10 columns"},
      {"nav going back", Kind::kReference, good + nav_rows(2), "", "%:31: time goes back by 0.290 s"},
      {"nav beyond the pole", Kind::kReference, with_line(good, 5, replaced(row, "40.1", "-95")), "", "%:5: latitude -95 deg"},
      {"nav without week", Kind::kReference, "0 1 40 5 0 0 0 0 0 0 0\n0 2 40 5 0 0 0 0 0 0 0\n", "",
       "%:1: seconds of week without a GPS week"},
      {"nav with a week of 12000", Kind::kReference, "12000 1 40 5 0 0 0 0 0 0 0\n", "format: nav", "%:1: GPS week 12000"},
      {"nav of seven columns", Kind::kReference, "2374 1 40 5 0 0 0\n", "format: nav", "%:1: 7 columns, expected column 8"},
      {"quaternion of norm 0", Kind::kReference, replaced(pose, "0 0 0 1\n", "0 0 0 0\n"), kPoseMapped,
       "%:1: a quaternion of norm 0"},
      {"quaternion of three", Kind::kReference, "1 40 5 0 0 0 0\n", kPoseMapped, "%:1: 7 columns, expected column 8"},
      {"NaN in most rows", Kind::kReference,
       [] {
         std::string s;
         for (int i = 0; i < 40; ++i) s += fmt::format("{} 40 5 0 nan 0 0 1\n", i);
         return s;
       }(),
       kPoseMapped, "%:1: a field that is empty or not finite"},
      {"CSV without a position", Kind::kReference, "time_s,roll_deg\n1,2\n", kWeek, "%: no column named \"lat_deg\""},
      {"SBET of half a record", Kind::kReference, std::string(100, '\1'), "format: sbet, " + kWeek,
       "%: 100 bytes, expected SBET records"},
      {"SBET of other doubles", Kind::kReference, bytes_of(outside, 3, 0.01), "format: sbet, " + kWeek,
       "%: record 1: not a position"},
      {"SBET going back", Kind::kReference, bytes_of(sbet, 3, 0.01) + bytes_of(sbet, 3, 0.01), "format: sbet, " + kWeek,
       "%: record 4: time goes back"},
      {"SBET without week", Kind::kReference, bytes_of(sbet, 3, 0.01), "", "%: record 1: seconds of week without a GPS week"},
  };
}

std::vector<Spoiled> receiver_files() {
  const std::string version = test::ubx(0x0a, 0x04, std::string(40, ' '));
  std::string wrong = version;
  wrong.back() = static_cast<char>(~wrong.back());
  const std::string ulog_head("ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0", 16);
  const std::string vectornav = "\xfa\x02" + test::Bytes().u2(1U << 9).u1(7).str();
  const std::string whole = vectornav + test::Bytes().u2(0).str();
  const std::string novatel = test::novatel_ascii("VERSIONA", test::NovAtelBody().u32(0));
  return {
      {"UBX without an IMU", Kind::kImu, version, "", "%: a UBX file without UBX-ESF-RAW and UBX-ESF-MEAS"},
      {"UBX without positions", Kind::kGnss, version, "", "%: a UBX file without UBX-NAV-PVT"},
      {"UBX with a wrong checksum alone", Kind::kGnss, wrong, "format: ubx", "%: a UBX file without UBX-NAV-PVT"},
      {"text as UBX", Kind::kGnss, pos(), "format: ubx", "%: a UBX file without UBX-NAV-PVT"},
      {"SBF without an IMU", Kind::kImu, test::sbf(4007, "ab"), "", "%: an SBF file without ExtSensorMeas"},
      {"SBF without positions", Kind::kGnss, test::sbf(4082, "ab"), "", "%: an SBF file without PVTGeodetic"},
      {"SBF of positions that are cut", Kind::kGnss, test::sbf(4007, "ab"), "", "%: an SBF file without PVTGeodetic"},
      {"text as SBF", Kind::kGnss, pos(), "format: sbf", "%: an SBF file without PVTGeodetic"},
      {"VectorNav without a checksum", Kind::kImu, whole, "format: vectornav", "%: 0 IMU samples in VectorNav messages"},
      {"text as VectorNav", Kind::kGnss, pos(), "format: vectornav", "%: VectorNav messages without a position"},
      {"NovAtel logs without an IMU", Kind::kImu, novatel, "", "%: 0 IMU samples in NovAtel logs"},
      {"NovAtel logs without positions", Kind::kGnss, novatel, "", "%: NovAtel logs without BESTGNSSPOS"},
      {"NovAtel logs without a trajectory", Kind::kReference, novatel, "", "%: NovAtel logs without INSPVA"},
      {"text as NovAtel", Kind::kGnss, pos(), "format: novatel", "%: NovAtel logs without BESTGNSSPOS"},
      {"ULog without anything", Kind::kImu, ulog_head, "", "%: a flight log with 0 IMU samples"},
      {"ULog without positions", Kind::kGnss, ulog_head, "", "%: a flight log without positions"},
      {"ULog cut in its header", Kind::kImu, ulog_head.substr(0, 12), "", "%: the header is cut off"},
      {"text as ULog", Kind::kImu, imu_csv(), "format: ulog", "%: no \"ULog\" at its beginning"},
  };
}

std::vector<Spoiled> event_files() {
  const std::string mapped = "columns: {time: 1, id: 2}, gps_week: 2374";
  const std::string rinex_header =
      fmt::format("{:<60}{:<20}\n", "     3.04           OBSERVATION DATA    M", "RINEX VERSION / TYPE") +
      fmt::format("{:<60}{:<20}\n", "G    1 C1C", "SYS / # / OBS TYPES") + fmt::format("{:<60}{:<20}\n", "", "END OF HEADER");
  const std::string epoch = "> 2021 09 22 06 30  0.0000000  0  1\nG05  21243381.127\n";
  return {
      {"empty", Kind::kEvents, "", kWeek, "%: the file is empty"},
      {"only a header", Kind::kEvents, "time_s,id\n", kWeek, "%:1: no row"},
      {"no week", Kind::kEvents, "time_s,id\n100.5,a\n", "", "%: seconds of week without a GPS week"},
      {"no time", Kind::kEvents, "t,id\n100.5,a\n", kWeek, "%: no column named \"time_s\""},
      {"no such name", Kind::kEvents, "time_s,id\n100.5,a\n", "columns: {time: time_s, id: image}, gps_week: 2374",
       "%: no column named \"image\""},
      {"a word for a time", Kind::kEvents, "100.5,a\nsoon,b\n", mapped, "%:2: \"soon\" in column 1"},
      {"a date for seconds", Kind::kEvents, "2025-07-08 19:34:18,a\n2025-07-08 19:34:19,b\n", mapped,
       "%:1: \"2025-07-08 19:34:18\""},
      {"seconds for a date", Kind::kEvents, "100.5,a\n101.5,b\n", "columns: {time: 1}, time: {kind: utc}",
       "%:1: time \"100.5\""},
      {"no date", Kind::kEvents, "2025-02-30 19:34:18,a\n", "columns: {time: 1}, time: {kind: utc}", "%:1:"},
      {"a first event of a date alone", Kind::kEvents, "a,2025-07-08 19:34:18\nb,2025-07-08 19:34:19\n",
       "columns: {time: 2, id: 1}, time: {kind: utc}", "%:1: \"2025-07-08 19:34:18\" in a line without a number"},
      {"no finite time", Kind::kEvents, "time_s,id\nnan,a\nnan,b\n", kWeek, "%: no time mark that can be used"},
      {"a latitude beyond the pole", Kind::kEvents, "time_s,lat_deg,lon_deg,height_m\n100,95,7,400\n", kWeek, "%:2:"},
      {"an edge of a table", Kind::kEvents, "time_s,id\n100.5,a\n", kWeek + ", edge: rising", "%: time marks without edges"},
      {"RINEX without events", Kind::kEvents, rinex_header + epoch, "", "%: no time mark"},
      {"RINEX without observations", Kind::kEvents, rinex_header + "> 2021 09 22 06 30  0.0000000  5  0\n", "",
       "%:4: no epoch with observations"},
      {"UBX without marks", Kind::kEvents, test::ubx(0x0a, 0x04, std::string(40, ' ')), "", "%: no time mark"},
      {"SBF without marks", Kind::kEvents, test::sbf(4007, "ab"), "", "%: no time mark"},
  };
}

TEST(SpoiledInput, EveryOneIsRefusedWithFileAndLine) {
  const Files files;
  auto all = imu_files();
  for (const auto& list : {binary_imu_files(), receiver_files(), gnss_files(), gnss_tables(), reference_files(), event_files()})
    all.insert(all.end(), list.begin(), list.end());
  EXPECT_GE(all.size(), 100U);
  int index = 0;
  for (const Spoiled& spoiled : all) {
    const std::string name = fmt::format("spoiled{}.dat", ++index);
    files.put(name, spoiled.content);
    const std::string message = refusal([&] {
      if (spoiled.kind == Kind::kImu) (void)files.imu(name, spoiled.keys);
      if (spoiled.kind == Kind::kGnss) (void)files.gnss(name, spoiled.keys);
      if (spoiled.kind == Kind::kReference) (void)files.reference(name, spoiled.keys);
      if (spoiled.kind == Kind::kEvents) (void)files.events(name, spoiled.keys);
    });
    EXPECT_NE(message, "") << spoiled.what << " was read";
    EXPECT_NE(message.find(replaced(spoiled.message, "%", name)), std::string::npos) << spoiled.what << "\n  " << message;
  }
}

TEST(SpoiledInput, NoFileADirectoryNotReadable) {
  const Files files;
  for (const std::string keys : {"", "format: imr", "format: csv", "format: binary"}) {
    EXPECT_NE(refusal([&] { (void)files.imu("missing.csv", keys); }).find("missing.csv: no such file"), std::string::npos)
        << keys;
    EXPECT_NE(refusal([&] { (void)files.imu(".", keys); }).find("is a directory"), std::string::npos) << keys;
  }
}

TEST(SpoiledConfiguration, NamesTheKey) {
  const Files files;
  files.put("imu.csv", imu_csv());
  const auto message = [&](const std::string& keys) { return refusal([&] { (void)files.imu("imu.csv", keys); }); };
  for (const std::string keys :
       {"values: increment", "time_tag: middle", "units: {gyro: deg}", "units: {accel: ft/s^2}", "gps_week: -1",
        "gps_week: soon", "columns: {gyro: [1, 2, 3], accel: [4, 5, 6]}", "columns: {time: 1, gyro: [1, 2], accel: [4, 5, 6]}",
        "columns: {time: 0, gyro: [1, 2, 3], accel: [4, 5, 6]}", "time: {kind: gps}", "time: {kind: row}", "time: {unit: min}",
        "binary: {type: i8}", "binary: {row: -1}"}) {
    const std::string text = message(keys);
    EXPECT_NE(text.find("run.yaml:1"), std::string::npos) << keys << " -> " << text;
  }
}

}  // namespace
}  // namespace coast::io
