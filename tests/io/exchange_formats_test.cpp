// Formats for other programs, each read back by a parser of this test alone.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/io/writers.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using test::Files;

constexpr double kPerDegree = 3.14159265358979323846 / 180.0;
const geo::GpsTime kStart = geo::GpsTime::from_week(2374, 243258.5);  // 2025-07-08 19:34:00.5 UTC

/// Climbs to the north-west near Quito, where signs are negative, and turns; fixed, then without GNSS.
std::vector<record::TrajectoryEpoch> climb() {
  std::vector<record::TrajectoryEpoch> epochs;
  const geo::Geodetic place{-0.1807 * kPerDegree, -78.4678 * kPerDegree, 2850.0};
  const geo::LocalFrame local(place);
  for (int i = 0; i < 40; ++i) {
    const double s = 0.25 * i;
    record::TrajectoryEpoch epoch;
    epoch.nav.t = kStart + s;
    epoch.nav.r_eb_e = local.to_ecef({8.0 * s, -6.0 * s, -2.0 * s});
    epoch.nav.v_eb_e = local.rotation() * Eigen::Vector3d(8.0, -6.0, -2.0);
    epoch.nav.q_b_e = Eigen::Quaterniond(local.rotation() * geo::dcm_from_euler({0.1 * std::sin(s), 0.2, -0.6435 + 0.05 * s}));
    epoch.cov.attitude = 1e-6 * Eigen::Matrix3d::Identity();
    if (i < 20) epoch.gnss = record::GnssSupport{record::FixQuality::kFixed, 14, 1.5, 12.0};
    epochs.push_back(epoch);
  }
  return epochs;
}

std::string written(const Files& files, std::string_view format, const WriterOptions& options = {}) {
  const std::string name = fmt::format("a.{}", format);
  const auto writer = trajectory_format(format).make(files.path(name), options);
  for (const auto& epoch : climb()) writer->write(epoch);
  writer->close();
  return files.get(name);
}

std::vector<std::vector<double>> pose_rows(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::vector<double>& row = rows.emplace_back();
    double value = 0.0;
    while (words >> value) row.push_back(value);
  }
  return rows;
}

/// Distance of a geodetic position in deg and m from ECEF, by the closed formula of the ellipsoid.
double distance(double latitude_deg, double longitude_deg, double height, const Eigen::Vector3d& r_e) {
  const double a = 6378137.0, f = 1.0 / 298.257223563, e2 = f * (2.0 - f);
  const double la = latitude_deg * kPerDegree, lo = longitude_deg * kPerDegree;
  const double n = a / std::sqrt(1.0 - e2 * std::sin(la) * std::sin(la));
  const Eigen::Vector3d r((n + height) * std::cos(la) * std::cos(lo), (n + height) * std::cos(la) * std::sin(lo),
                          (n * (1.0 - e2) + height) * std::sin(la));
  return (r - r_e).norm();
}

TEST(Tum, PosesAreThoseOfTheTrajectory) {
  const Files files;
  const std::string text = written(files, "tum");
  const auto rows = pose_rows(text);
  const auto epochs = climb();
  ASSERT_EQ(rows.size(), epochs.size());
  EXPECT_EQ(text.substr(text.find("\n1") + 1, 20), "1752003240.500000000");  // seconds since 1970 of 19:34:00.5 UTC
  const geo::LocalFrame local(geo::geodetic_from_ecef(epochs[0].nav.r_eb_e));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double>& row = rows[i];
    ASSERT_EQ(row.size(), 8U);
    EXPECT_NEAR(row[0] - rows[0][0], 0.25 * static_cast<double>(i), 1e-6);
    const Eigen::Vector3d ned(row[2], row[1], -row[3]);
    EXPECT_LT((local.to_ecef(ned) - epochs[i].nav.r_eb_e).norm(), 2e-6) << i;
    // The nose, the left side and the top of the body as vectors.
    const Eigen::Quaterniond q(row[7], row[4], row[5], row[6]);
    const auto seen = [&](const Eigen::Vector3d& flu) {
      const Eigen::Vector3d enu = q * flu;
      return Eigen::Vector3d(local.rotation() * Eigen::Vector3d(enu.y(), enu.x(), -enu.z()));
    };
    EXPECT_LT((seen(Eigen::Vector3d::UnitX()) - epochs[i].nav.q_b_e * Eigen::Vector3d::UnitX()).norm(), 1e-10) << i;
    EXPECT_LT((seen(Eigen::Vector3d::UnitY()) + epochs[i].nav.q_b_e * Eigen::Vector3d::UnitY()).norm(), 1e-10) << i;
    EXPECT_LT((seen(Eigen::Vector3d::UnitZ()) + epochs[i].nav.q_b_e * Eigen::Vector3d::UnitZ()).norm(), 1e-10) << i;
  }
}

TEST(Kitti, PosesAreRelativeToTheFirst) {
  const Files files;
  const auto rows = pose_rows(written(files, "kitti"));
  const auto times = pose_rows(files.get("a.times"));
  const auto epochs = climb();
  ASSERT_EQ(rows.size(), epochs.size());
  ASSERT_EQ(times.size(), epochs.size());
  const record::NavState& first = epochs[0].nav;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), 12U);
    EXPECT_NEAR(times[i].at(0), 0.25 * static_cast<double>(i), 1e-9);
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> pose(rows[i].data());
    if (i == 0) {
      EXPECT_LT((pose.leftCols<3>() - Eigen::Matrix3d::Identity()).norm() + pose.col(3).norm(), 1e-10);
    }
    // Right, down, forward of the first pose.
    const Eigen::Vector3d forward_right_down = first.q_b_e.conjugate() * (epochs[i].nav.r_eb_e - first.r_eb_e);
    EXPECT_NEAR(pose(0, 3), forward_right_down.y(), 2e-6) << i;
    EXPECT_NEAR(pose(1, 3), forward_right_down.z(), 2e-6) << i;
    EXPECT_NEAR(pose(2, 3), forward_right_down.x(), 2e-6) << i;
    const Eigen::Vector3d nose = first.q_b_e.conjugate() * (epochs[i].nav.q_b_e * Eigen::Vector3d::UnitX());
    EXPECT_LT((pose.col(2) - Eigen::Vector3d(nose.y(), nose.z(), nose.x())).norm(), 1e-10) << i;
  }
}

TEST(Gpx, PointsTimesAndHeights) {
  const Files files;
  for (const bool geoid : {false, true}) {
    const std::string text = written(files, "gpx", {geoid ? std::optional<double>(25.5) : std::nullopt, 0.0});
    const auto epochs = climb();
    std::size_t at = 0, point = 0, segments = 0;
    for (std::size_t i = 0; (i = text.find("<trkseg>", i)) != std::string::npos; ++i) ++segments;
    EXPECT_EQ(segments, 2U);
    while ((at = text.find("<trkpt", at)) != std::string::npos) {
      double latitude = 0.0, longitude = 0.0, elevation = 0.0, second = 0.0;
      int minute = 0;
      ASSERT_EQ(
          std::sscanf(text.c_str() + at, "<trkpt lat=\"%lf\" lon=\"%lf\"><ele>%lf</ele><time>2025-07-08T19:%d:%lfZ</time>",
                      &latitude, &longitude, &elevation, &minute, &second),
          5);
      const std::size_t i = point < 21 ? point : point - 1;  // the last of the first segment is the first of the next
      EXPECT_LT(distance(latitude, longitude, elevation + (geoid ? 25.5 : 0.0), epochs.at(i).nav.r_eb_e), 2e-4) << i;
      EXPECT_NEAR(60.0 * (minute - 34) + second, 0.5 + 0.25 * static_cast<double>(i), 6e-4) << i;
      ++point;
      ++at;
    }
    EXPECT_EQ(point, 41U);
    EXPECT_EQ(text.find("<fix>dgps</fix>") != std::string::npos, true);
    EXPECT_EQ(text.find("<fix>none</fix>") != std::string::npos, true);
    EXPECT_EQ(text.find("<geoidheight>25.500</geoidheight>") != std::string::npos, geoid);
    EXPECT_TRUE(text.ends_with("</trkseg>\n</trk>\n</gpx>\n"));
  }
}

TEST(GeoJson, LinesWithTimesByQuality) {
  const Files files;
  const auto json = nlohmann::json::parse(written(files, "geojson", {std::nullopt, 0.0}));
  const auto epochs = climb();
  EXPECT_EQ(json["type"], "FeatureCollection");
  ASSERT_EQ(json["features"].size(), 2U);
  EXPECT_EQ(json["features"][0]["properties"]["quality"], "fixed");
  EXPECT_EQ(json["features"][1]["properties"]["quality"], "without GNSS");
  std::size_t i = 0;
  for (const auto& feature : json["features"]) {
    EXPECT_EQ(feature["geometry"]["type"], "LineString");
    const auto& places = feature["geometry"]["coordinates"];
    EXPECT_EQ(feature["properties"]["coordTimes"].size(), places.size());
    if (i > 0) --i;  // where one ends the next begins
    for (const auto& place : places) {
      EXPECT_LT(distance(place[1].get<double>(), place[0].get<double>(), place[2].get<double>(), epochs.at(i).nav.r_eb_e),
                2e-4);
      ++i;
    }
  }
  EXPECT_EQ(i, epochs.size());
  EXPECT_EQ(json["features"][0]["properties"]["coordTimes"][1], "2025-07-08T19:34:00.750Z");
}

TEST(GeoJson, ASinglePointIsNoLine) {
  const Files files;
  const auto writer = trajectory_format("geojson").make(files.path("a.geojson"), {});
  writer->write(climb().front());
  writer->close();
  const auto json = nlohmann::json::parse(files.get("a.geojson"));
  EXPECT_EQ(json["features"][0]["geometry"]["type"], "Point");
  EXPECT_EQ(json["features"][0]["geometry"]["coordinates"].size(), 3U);
}

std::vector<std::string> fields_of(const std::string& sentence) {
  std::vector<std::string> fields;
  std::istringstream stream(sentence.substr(0, sentence.find('*')));
  std::string field;
  while (std::getline(stream, field, ',')) fields.push_back(field);
  return fields;
}

/// "ddmm.mmmm" and its letter, deg.
double nmea_degrees(const std::string& text, const std::string& letter) {
  const std::size_t split = text.find('.') - 2;
  const double degrees = std::stod(text.substr(0, split)) + std::stod(text.substr(split)) / 60.0;
  return letter == "S" || letter == "W" ? -degrees : degrees;
}

/// Sentences by type, their checksums verified.
std::map<std::string, std::vector<std::vector<std::string>>> sentences_of(const std::string& text) {
  std::map<std::string, std::vector<std::vector<std::string>>> all;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    EXPECT_EQ(line.back(), '\r');
    const std::size_t star = line.find('*');
    int sum = 0;
    for (std::size_t i = 1; i < star; ++i) sum ^= line[i];
    EXPECT_EQ(std::stoi(line.substr(star + 1, 2), nullptr, 16), sum) << line;
    EXPECT_EQ(line.size(), star + 4) << line;
    const auto fields = fields_of(line);
    all[fields[0]].push_back(fields);
  }
  return all;
}

TEST(Nmea, SentencesSayWhatTheTrajectoryDoes) {
  const Files files;
  auto all = sentences_of(written(files, "nmea", {25.5}));
  const auto epochs = climb();
  ASSERT_EQ(all["$GNGGA"].size(), epochs.size());
  ASSERT_EQ(all["$GNRMC"].size(), epochs.size());
  ASSERT_EQ(all["$GNHDT"].size(), epochs.size());
  ASSERT_EQ(all["$PASHR"].size(), epochs.size());
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    const auto& gga = all["$GNGGA"][i];
    EXPECT_LT(distance(nmea_degrees(gga[2], gga[3]), nmea_degrees(gga[4], gga[5]), std::stod(gga[9]) + std::stod(gga[11]),
                       epochs[i].nav.r_eb_e),
              3e-4);
    EXPECT_EQ(gga[6], i < 20 ? "4" : "6");
    EXPECT_EQ(gga[7], i < 20 ? "14" : "00");
    EXPECT_EQ(gga[1], fmt::format("1934{:06.3f}", 0.5 + 0.25 * static_cast<double>(i)));
    const auto& rmc = all["$GNRMC"][i];
    EXPECT_EQ(rmc[9], "080725");
    EXPECT_EQ(rmc[2], "A");
    EXPECT_NEAR(std::stod(rmc[7]), 10.0 * 3600.0 / 1852.0, 2e-3);
    EXPECT_NEAR(std::stod(rmc[8]), 360.0 - std::atan2(6.0, 8.0) / kPerDegree, 6e-3);
    const double yaw = (-0.6435 + 0.0125 * static_cast<double>(i)) / kPerDegree;
    EXPECT_NEAR(std::stod(all["$GNHDT"][i][1]), yaw < 0.0 ? yaw + 360.0 : yaw, 2e-3);
    const auto& pashr = all["$PASHR"][i];
    EXPECT_NEAR(std::stod(pashr[4]), 0.1 * std::sin(0.25 * static_cast<double>(i)) / kPerDegree, 2e-3);
    EXPECT_NEAR(std::stod(pashr[5]), 0.2 / kPerDegree, 2e-3);
    EXPECT_NEAR(std::stod(pashr[8]), 1e-3 / kPerDegree, 1e-3);  // pitch of an isotropic psi
  }
}

TEST(Nmea, RoundsWholeAnglesAndSecondsAtOnce) {
  const Files files;
  const auto writer = trajectory_format("nmea").make(files.path("a.nmea"), {});
  record::TrajectoryEpoch epoch;
  const geo::Geodetic p{(46.0 + 59.99999999 / 60.0) * kPerDegree, (-7.0 - 1e-12) * kPerDegree, 0.0};
  epoch.nav.t = geo::GpsTime::from_week(2374, 243257.9999);  // 19:33:59.9999 UTC
  epoch.nav.r_eb_e = geo::ecef_from_geodetic(p);
  epoch.nav.q_b_e = Eigen::Quaterniond(geo::C_n_e(p) * geo::dcm_from_euler({0.0, 0.0, -1e-7}));
  writer->write(epoch);
  writer->close();
  const std::string text = files.get("a.nmea");
  EXPECT_NE(text.find("$GNGGA,193400.000,4700.0000000,N,00700.0000000,W,"), std::string::npos) << text;
  EXPECT_NE(text.find("$GNHDT,0.000,T*"), std::string::npos) << text;
}

TEST(Exchange, WithoutCovarianceNoneIsWritten) {
  const Files files;
  WriterOptions options;
  options.covariance = false;
  const std::string csv = written(files, "csv", options);
  EXPECT_TRUE(csv.substr(0, csv.find('\n')).ends_with(",yaw_deg")) << csv.substr(0, csv.find('\n'));
  EXPECT_FALSE(written(files, "sbet", options).empty());
  EXPECT_FALSE(std::filesystem::exists(files.path("a.smrmsg")));
  EXPECT_NE(written(files, "nmea", options).find(",,,,,2,0*"), std::string::npos);
}

}  // namespace
}  // namespace coast::io
