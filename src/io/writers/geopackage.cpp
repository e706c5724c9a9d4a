// GeoPackage: layers `trajectory_lines`, one line for each stretch of equal GNSS quality, and `trajectory_points` with time,
// attitude and standard deviations, both thinned; then `fixes` and `events`.

#include <fmt/format.h>

#include <cmath>

#include "../grid_columns.hpp"
#include "../state_columns.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/writers.hpp"
#include "geopackage_base.hpp"
#include "quality_tracks.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

using SqlColumns = std::vector<std::pair<std::string, std::string>>;

constexpr const char* kReal = "DOUBLE";

const GeoLayer& line_layer() {
  static const GeoLayer layer{"trajectory_lines",
                              "trajectory, a line for each stretch of equal GNSS quality",
                              "LINESTRING",
                              {{"quality", "TEXT"}, {"from_utc", "DATETIME"}, {"to_utc", "DATETIME"}, {"colour", "TEXT"}}};
  return layer;
}

const SqlColumns kTimeColumns{{"utc", "DATETIME"}, {"gps_week", "INTEGER"}, {"sow_s", kReal}};
const SqlColumns kAttitudeColumns{
    {"roll_deg", kReal}, {"pitch_deg", kReal}, {"heading_true_deg", kReal}, {"heading_grid_deg", kReal}};
const SqlColumns kSdColumns{{"sdn_m", kReal}, {"sde_m", kReal}, {"sdd_m", kReal}};
const SqlColumns kAttitudeSdColumns{{"sd_roll_deg", kReal}, {"sd_pitch_deg", kReal}, {"sd_heading_deg", kReal}};

SqlColumns together(std::initializer_list<SqlColumns> parts) {
  SqlColumns all;
  for (const SqlColumns& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

GeoLayer point_layer() {
  return {"trajectory_points", "trajectory, points at least 1 m apart", "POINT",
          together({kTimeColumns, {{"quality", "TEXT"}}, kAttitudeColumns, kSdColumns, kAttitudeSdColumns})};
}
GeoLayer fix_layer() {
  return {"fixes", "positions of the GNSS antenna", "POINT",
          together({kTimeColumns, {{"quality", "TEXT"}, {"satellites", "INTEGER"}}, kSdColumns})};
}
GeoLayer event_layer() {
  return {"events", "events, such as exposures of a camera", "POINT",
          together({{{"id", "TEXT"}}, kTimeColumns, kAttitudeColumns, kSdColumns, kAttitudeSdColumns})};
}

void put_time_values(std::vector<SqlValue>& values, geo::GpsTime t) {
  values.emplace_back(utc_text(t));
  values.emplace_back(static_cast<std::int64_t>(t.week()));
  values.emplace_back(t.sow());
}

/// Roll, pitch, true heading, and relative to grid north, which is absent without a grid.
void put_attitude_values(std::vector<SqlValue>& values, const record::NavState& nav, const geo::Euler& attitude,
                         const Projection* projection) {
  values.emplace_back(attitude.roll / geo::kDegree);
  values.emplace_back(attitude.pitch / geo::kDegree);
  values.emplace_back(heading_deg(attitude.yaw));
  if (projection != nullptr)
    values.emplace_back(heading_deg(attitude.yaw - projection->convergence(nav.r_eb_e, nav.t)));
  else
    values.emplace_back();
}

void put_sd_values(std::vector<SqlValue>& values, const Eigen::Matrix3d& cov, double unit) {
  for (const double variance : cov.diagonal()) values.emplace_back(std::sqrt(std::max(0.0, variance)) / unit);
}

void put_attitude_sd_values(std::vector<SqlValue>& values, const Eigen::Matrix3d& cov, const geo::Euler& attitude) {
  const Eigen::Matrix3d J = geo::euler_jacobian(attitude);
  put_sd_values(values, J * cov * J.transpose(), geo::kDegree);
}

void add_fixes(GeoPackage& package, const std::vector<record::GnssFix>& fixes) {
  const GeoLayer layer = fix_layer();
  package.create(layer);
  for (const record::GnssFix& fix : fixes) {
    std::vector<SqlValue> values;
    put_time_values(values, fix.t);
    values.emplace_back(track_qualities()[1 + static_cast<std::size_t>(fix.quality)].name);
    if (fix.satellites)
      values.emplace_back(static_cast<std::int64_t>(*fix.satellites));
    else
      values.emplace_back();
    put_sd_values(values, fix.position_cov_n, 1.0);
    package.add(layer, {package.coordinates(fix.r_ea_e, fix.t)}, values);
  }
}

void add_events(GeoPackage& package, const std::vector<record::MarkedState>& states, const Projection* projection) {
  const GeoLayer layer = event_layer();
  package.create(layer);
  for (const record::MarkedState& state : states) {
    const geo::Euler attitude = local_state(state.nav).attitude;
    std::vector<SqlValue> values{state.mark.id};
    put_time_values(values, state.nav.t);
    put_attitude_values(values, state.nav, attitude, projection);
    put_sd_values(values, state.cov.position, 1.0);
    put_attitude_sd_values(values, state.cov.attitude, attitude);
    package.add(layer, {package.coordinates(state.nav.r_eb_e, state.nav.t)}, values);
  }
}

class GeoPackageWriter final : public TrajectoryWriter {
 public:
  GeoPackageWriter(const std::filesystem::path& path, const WriterOptions& options)
      : options_(options),
        package_(path, options.projection.get()),
        points_(point_layer()),
        tracks_(options.min_step_m, [this](const auto& quality, const auto& track) { put_line(quality, track); }) {
    package_.create(line_layer());
    package_.create(points_);
  }

  void write(const record::TrajectoryEpoch& epoch) override {
    tracks_.add(epoch);
    if (last_point_ && (epoch.nav.r_eb_e - *last_point_).norm() < options_.min_step_m) return;
    last_point_ = epoch.nav.r_eb_e;
    put_point(epoch);
  }

  void close() override {
    tracks_.finish();
    package_.close();
  }

 private:
  void put_line(const TrackQuality& quality, const std::vector<TrackPoint>& track) {
    std::vector<Eigen::Vector3d> coordinates;
    for (const TrackPoint& point : track) coordinates.push_back(package_.coordinates(point.r_e, point.t));
    if (coordinates.size() == 1) coordinates.push_back(coordinates.front());  // a line has two points at least
    package_.add(line_layer(), coordinates,
                 {quality.name, utc_text(track.front().t), utc_text(track.back().t), fmt::format("#{}", quality.rgb)});
  }

  void put_point(const record::TrajectoryEpoch& epoch) {
    const geo::Euler attitude = local_state(epoch.nav).attitude;
    std::vector<SqlValue> values;
    put_time_values(values, epoch.nav.t);
    values.emplace_back(track_qualities()[epoch.gnss ? 1 + static_cast<std::size_t>(epoch.gnss->quality) : 0].name);
    if (options_.attitude)
      put_attitude_values(values, epoch.nav, attitude, options_.projection.get());
    else
      values.resize(values.size() + kAttitudeColumns.size());
    if (options_.covariance) {
      put_sd_values(values, epoch.cov.position, 1.0);
      put_attitude_sd_values(values, epoch.cov.attitude, attitude);
    } else {
      values.resize(values.size() + kSdColumns.size() + kAttitudeSdColumns.size());
    }
    package_.add(points_, {package_.coordinates(epoch.nav.r_eb_e, epoch.nav.t)}, values);
  }

  WriterOptions options_;
  GeoPackage package_;
  GeoLayer points_;
  QualityTracks tracks_;
  std::optional<Eigen::Vector3d> last_point_;
};

}  // namespace

TrajectoryFormat gpkg_trajectory() {
  TrajectoryFormat format{"gpkg", "GeoPackage: lines by quality, points"};
  format.make = [](const std::filesystem::path& file, const WriterOptions& options) {
    return std::make_unique<GeoPackageWriter>(file, options);
  };
  return format;
}

void write_gnss_geopackage(const std::filesystem::path& path, const record::GnssRecording& gnss, const Projection* projection) {
  GeoPackage package(path, projection);
  add_fixes(package, gnss.fixes);
  package.close();
}

void add_to_geopackage(const std::filesystem::path& path, const std::vector<record::GnssFix>& fixes,
                       const std::vector<record::MarkedState>* states, const Projection* projection) {
  GeoPackage package = GeoPackage::opened(path, projection);
  add_fixes(package, fixes);
  if (states != nullptr) add_events(package, *states, projection);
  package.close();
}

}  // namespace coast::io
