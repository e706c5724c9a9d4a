// GeoPackages, read back by SQLite with a parser of geometries of this test alone, and by ogrinfo.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/projection.hpp"
#include "coast/io/writers.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

const geo::Geodetic kAirfield{48.1 * geo::kDegree, 11.5 * geo::kDegree, 520.0};

/// North at 8 m/s with two qualities, for ten seconds.
std::vector<record::TrajectoryEpoch> taxiing() {
  std::vector<record::TrajectoryEpoch> epochs;
  const geo::LocalFrame local(kAirfield);
  for (int i = 0; i < 40; ++i) {
    record::TrajectoryEpoch epoch;
    epoch.nav.t = geo::GpsTime::from_week(2374, 243258.5) + 0.25 * i;
    epoch.nav.r_eb_e = local.to_ecef({2.0 * i, 0.0, 0.0});
    epoch.nav.q_b_e = Eigen::Quaterniond(local.rotation() * geo::dcm_from_euler({0.01, 0.02, -0.5}));
    epoch.cov.position = 4e-4 * Eigen::Matrix3d::Identity();
    epoch.cov.attitude = 1e-6 * Eigen::Matrix3d::Identity();
    if (i < 20) epoch.gnss = record::GnssSupport{record::FixQuality::kFixed, 14, 1.5, 12.0};
    epochs.push_back(epoch);
  }
  return epochs;
}

void write_taxiing(const std::filesystem::path& path, std::shared_ptr<const Projection> projection = nullptr) {
  WriterOptions options;
  options.projection = std::move(projection);
  const auto writer = trajectory_format("gpkg").make(path, options);
  for (const auto& epoch : taxiing()) writer->write(epoch);
  writer->close();
}

std::shared_ptr<const Projection> utm() {
  ProjectionOptions options;
  options.crs = "EPSG:25832";
  return std::make_shared<Projection>(options);
}

class Base {
 public:
  explicit Base(const std::filesystem::path& path) {
    EXPECT_EQ(sqlite3_open_v2(path.c_str(), &base_, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  }
  ~Base() { sqlite3_close(base_); }
  Base(const Base&) = delete;
  Base& operator=(const Base&) = delete;
  /// Rows of texts; blobs as they are.
  [[nodiscard]] std::vector<std::vector<std::string>> rows(const std::string& sql) const {
    std::vector<std::vector<std::string>> all;
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(base_, sql.c_str(), -1, &statement, nullptr), SQLITE_OK) << sqlite3_errmsg(base_);
    while (sqlite3_step(statement) == SQLITE_ROW) {
      std::vector<std::string>& row = all.emplace_back();
      for (int i = 0; i < sqlite3_column_count(statement); ++i) {
        const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, i));
        row.emplace_back(bytes == nullptr ? "" : bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement, i)));
      }
    }
    sqlite3_finalize(statement);
    return all;
  }

 private:
  sqlite3* base_ = nullptr;
};

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.substr(at, sizeof(T)).c_str(), sizeof(T));
  return value;
}

/// Coordinates of a geometry in the SRS that is expected.
std::vector<Eigen::Vector3d> geometry(const std::string& blob, std::int32_t srs) {
  EXPECT_EQ(blob.substr(0, 4), std::string("GP\0\1", 4));
  EXPECT_EQ(number_at<std::int32_t>(blob, 4), srs);
  EXPECT_EQ(blob.at(8), 1);
  const auto type = number_at<std::uint32_t>(blob, 9);
  EXPECT_TRUE(type == 1001 || type == 1002) << type;
  const std::size_t count = type == 1002 ? number_at<std::uint32_t>(blob, 13) : 1;
  std::size_t at = type == 1002 ? 17 : 13;
  EXPECT_EQ(blob.size(), at + 24 * count);
  std::vector<Eigen::Vector3d> places;
  for (std::size_t i = 0; i < count; ++i, at += 24)
    places.emplace_back(number_at<double>(blob, at), number_at<double>(blob, at + 8), number_at<double>(blob, at + 16));
  return places;
}

TEST(GeoPackage, LinesAndPointsOfATrajectory) {
  const test::Files files;
  write_taxiing(files.path("a.gpkg"));
  const Base base(files.path("a.gpkg"));
  EXPECT_EQ(base.rows("PRAGMA integrity_check")[0][0], "ok");
  EXPECT_EQ(base.rows("PRAGMA application_id")[0][0], fmt::format("{}", 0x47504B47));
  const auto lines = base.rows("SELECT geom, quality, from_utc, to_utc FROM trajectory_lines");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0][1], "fixed");
  EXPECT_EQ(lines[1][1], "without GNSS");
  EXPECT_EQ(lines[0][3], lines[1][2]);  // where one ends the next begins
  const auto points = base.rows("SELECT geom, utc, heading_true_deg, sdn_m, heading_grid_deg FROM trajectory_points");
  ASSERT_EQ(points.size(), 40U);
  const auto epochs = taxiing();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d place = geometry(points[i][0], 4979).at(0);
    const Eigen::Vector3d r_e = geo::ecef_from_geodetic({place.y() * geo::kDegree, place.x() * geo::kDegree, place.z()});
    EXPECT_LT((r_e - epochs[i].nav.r_eb_e).norm(), 1e-7);
    EXPECT_NEAR(std::stod(points[i][2]), 360.0 - 0.5 / geo::kDegree, 1e-4);
    EXPECT_NEAR(std::stod(points[i][3]), 0.02, 1e-9);
    EXPECT_EQ(points[i][4], "");
  }
  EXPECT_EQ(points[1][1], "2025-07-08T19:34:00.750Z");
}

TEST(GeoPackage, CoordinatesOfAProjection) {
  const test::Files files;
  const auto projection = utm();
  write_taxiing(files.path("a.gpkg"), projection);
  const Base base(files.path("a.gpkg"));
  const auto epochs = taxiing();
  const auto points = base.rows("SELECT geom, heading_true_deg, heading_grid_deg FROM trajectory_points");
  ASSERT_EQ(points.size(), epochs.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d place = geometry(points[i][0], 25832).at(0);
    const GridPosition p = projection->at(epochs[i].nav.r_eb_e, epochs[i].nav.t);
    EXPECT_EQ(place, Eigen::Vector3d(p.easting, p.northing, p.height));
    const double convergence = projection->convergence(epochs[i].nav.r_eb_e, epochs[i].nav.t) / geo::kDegree;
    EXPECT_NEAR(std::stod(points[i][1]) - std::stod(points[i][2]), convergence, 1e-6);
  }
  const auto system = base.rows("SELECT organization, definition_12_063 FROM gpkg_spatial_ref_sys WHERE srs_id = 25832");
  ASSERT_EQ(system.size(), 1U);
  EXPECT_EQ(system[0][0], "EPSG");
  EXPECT_NE(system[0][1].find("UTM zone 32N"), std::string::npos);
  const auto contents = base.rows("SELECT min_y, max_y FROM gpkg_contents WHERE table_name = 'trajectory_points'");
  EXPECT_NEAR(std::stod(contents[0][1]) - std::stod(contents[0][0]), 78.0, 0.05);
}

TEST(GeoPackage, FixesAndEventsAreAdded) {
  const test::Files files;
  const std::filesystem::path path = files.path("a.gpkg");
  write_taxiing(path);
  record::MarkedState exposure;
  exposure.mark.id = "it's 1.jpg";
  exposure.nav = taxiing()[3].nav;
  const std::vector<record::MarkedState> states{exposure};
  record::GnssFix fix;
  fix.t = exposure.nav.t;
  fix.r_ea_e = exposure.nav.r_eb_e;
  fix.position_cov_n = Eigen::Matrix3d::Identity();
  fix.quality = record::FixQuality::kFloat;
  add_to_geopackage(path, {fix, fix}, &states, nullptr);
  {
    const Base base(path);
    EXPECT_EQ(base.rows("PRAGMA integrity_check")[0][0], "ok");
    EXPECT_EQ(base.rows("SELECT quality, satellites FROM fixes")[1][0], "float");
    EXPECT_EQ(base.rows("SELECT id FROM events")[0][0], "it's 1.jpg");
    EXPECT_EQ(base.rows("SELECT fid FROM trajectory_points").size(), 40U);
    EXPECT_EQ(base.rows("SELECT table_name FROM gpkg_contents").size(), 4U);
  }
  // None of either: layers without features.
  write_taxiing(path);
  const std::vector<record::MarkedState> none;
  add_to_geopackage(path, {}, &none, nullptr);
  const Base base(path);
  EXPECT_EQ(base.rows("SELECT fid FROM events").size(), 0U);
  EXPECT_EQ(base.rows("SELECT min_x FROM gpkg_contents WHERE table_name = 'events'")[0][0], "");
}

TEST(GeoPackage, NoneIsLeftOfAWriterThatIsNotClosed) {
  const test::Files files;
  {
    const auto writer = trajectory_format("gpkg").make(files.path("a.gpkg"), {});
    writer->write(taxiing().front());
  }
  EXPECT_FALSE(std::filesystem::exists(files.path("a.gpkg")));
  EXPECT_TRUE(std::filesystem::is_empty(files.path("a.gpkg").parent_path()));
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>&1").c_str(), "r"), &pclose);
  std::string text;
  std::array<char, 4096> block{};
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe.get())) text.append(block.data(), n);
  return text;
}

TEST(GeoPackage, IsReadByOgr) {
  if (!std::filesystem::exists("/usr/bin/ogrinfo")) GTEST_SKIP() << "no ogrinfo (gdal-bin)";
  const test::Files files;
  const std::filesystem::path path = files.path("a.gpkg");
  for (const bool projected : {false, true}) {
    const auto projection = projected ? utm() : nullptr;
    write_taxiing(path, projection);
    add_to_geopackage(path, {}, nullptr, projection.get());
    const std::string told = output_of(fmt::format("ogrinfo -so -al '{}'", path.string()));
    EXPECT_EQ(told.find("ERROR"), std::string::npos) << told;
    EXPECT_EQ(told.find("Warning"), std::string::npos) << told;
    EXPECT_NE(told.find("Feature Count: 40"), std::string::npos) << told;
    EXPECT_NE(told.find("3D Point"), std::string::npos) << told;
    EXPECT_NE(told.find(projected ? "UTM zone 32N" : "WGS 84"), std::string::npos) << told;
  }
}

}  // namespace
}  // namespace coast::io
