#include "coast/io/recording_formats.hpp"

#include "coast/io/rinex.hpp"
#include "coast/io/writers.hpp"

namespace coast::io {

namespace {

using Path = std::filesystem::path;

bool has_observations(const FileContents& c) {
  return c.observations.has_value();
}
bool has_navigation(const FileContents& c) {
  return c.navigation.has_value();
}
bool has_imu(const FileContents& c) {
  return c.imu.has_value();
}
bool has_fixes(const FileContents& c) {
  return c.gnss.has_value();
}
bool has_marks(const FileContents& c) {
  return c.marks.has_value();
}

constexpr RecordingPart kObservationPart{
    "obs", "observations", has_observations,
    [](const Path& file, const FileContents& c, const Projection*) { write_observations(file, *c.observations); }};
constexpr RecordingPart kNavigationPart{
    "nav", "ephemerides", has_navigation,
    [](const Path& file, const FileContents& c, const Projection*) { write_navigation(file, *c.navigation); }};
constexpr RecordingPart kImuPart{"imu.csv", "IMU", has_imu, [](const Path& file, const FileContents& c, const Projection*) {
                                   write_imu_csv(file, *c.imu, WeekColumn::kWith);
                                 }};
constexpr RecordingPart kFixPart{
    "gnss.csv", "positions", has_fixes,
    [](const Path& file, const FileContents& c, const Projection*) { write_gnss_csv(file, *c.gnss); }};
constexpr RecordingPart kMarkPart{
    "marks.csv", "time marks", has_marks,
    [](const Path& file, const FileContents& c, const Projection*) { write_time_marks_csv(file, *c.marks); }};
constexpr RecordingPart kPosPart{"pos", "positions", has_fixes, [](const Path& file, const FileContents& c, const Projection*) {
                                   write_gnss_pos(file, *c.gnss);
                                 }};

constexpr RecordingPart kGridPart{
    "gnss.grid.csv", "positions in a projected CRS", has_fixes,
    [](const Path& file, const FileContents& c, const Projection* projection) { write_gnss_grid(file, *c.gnss, *projection); }};

constexpr RecordingPart kGeoPackagePart{"gnss.gpkg", "positions", has_fixes,
                                        [](const Path& file, const FileContents& c, const Projection* projection) {
                                          write_gnss_geopackage(file, *c.gnss, projection);
                                        }};

bool has_imu_or_fixes(const FileContents& c) {
  return has_imu(c) || has_fixes(c);
}
constexpr RecordingPart kBagPart{"mcap", "IMU and positions", has_imu_or_fixes,
                                 [](const Path& file, const FileContents& c, const Projection*) {
                                   write_mcap(file, c.imu ? &*c.imu : nullptr, c.gnss ? &*c.gnss : nullptr);
                                 }};

}  // namespace

const std::vector<RecordingFormat>& recording_formats() {
  static const std::vector<RecordingFormat> table = {
      {"rinex", "RINEX 3.05: observations (.obs), ephemerides (.nav)", {kObservationPart, kNavigationPart}},
      {"csv", "tables of the IMU (.imu.csv), positions (.gnss.csv), time marks (.marks.csv)", {kImuPart, kFixPart, kMarkPart}},
      {"pos", "positions as RTKLIB .pos", {kPosPart}},
      {"grid", "positions as CSV in a projected CRS (.gnss.grid.csv)", {kGridPart}},
      {"gpkg", "GeoPackage of positions (.gnss.gpkg)", {kGeoPackagePart}},
      {"mcap", "bag of ROS 2: IMU and positions", {kBagPart}},
  };
  return table;
}

}  // namespace coast::io
