#pragma once
// Files that coast writes. Each is written under a temporary name in the same folder and renamed when complete, so that a crash
// or a full disk leaves no partial file under the final name.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/record/aid.hpp"
#include "coast/record/error.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/time_mark.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::io {

class Projection;

/// A file that appears complete or not at all. If the target exists and is not a regular file (a pipe, a device), it is written
/// directly. In a results folder (results_folder.hpp) only files that coast wrote are replaced.
class AtomicFile {
 public:
  /// @throws OutputError  the folder is missing or not writable; names the path
  /// @throws InputError   the file exists and was not written by coast, or was read by this job
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();  ///< removes the temporary file if it was not committed
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// @throws OutputError  e.g. "No space left on device"
  void write(std::string_view bytes);
  /// Flushes, closes, renames.  @throws OutputError
  void commit();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail(int error);
  void remove_part();
  std::filesystem::path path_;
  std::filesystem::path written_;  ///< the temporary name
  std::uintmax_t size_ = 0;        ///< bytes written
  int descriptor_ = -1;
};

/// Removes partial files and ends the process: on a signal, called from a dedicated thread, not from the handler.
[[noreturn]] void exit_without_unfinished_files(int status);

/// Writes a text file in one call.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Writes a trajectory epoch by epoch, in time order.
class TrajectoryWriter {
 public:
  virtual ~TrajectoryWriter() = default;
  /// @throws OutputError
  virtual void write(const record::TrajectoryEpoch& epoch) = 0;
  /// Completes the file. Without this call no file remains.  @throws OutputError
  virtual void close() = 0;
};

/// What a trajectory file is written with, beside the epochs.
struct WriterOptions {
  std::optional<double> geoid_height_m;  ///< height of the geoid above the height reference of the trajectory, m
  double min_step_m = 1.0;               ///< least distance between points of lines on maps: kml, gpx, geojson
  bool covariance = true;                ///< whether epochs have one; where they have none, none is written
  bool attitude = true;                  ///< likewise
  std::shared_ptr<const Projection> projection = nullptr;  ///< for formats with coordinates of a map
};

/// A file format of trajectories that coast writes.
struct TrajectoryFormat {
  std::string_view name;            ///< as in `output.formats`
  std::string_view description;     ///< one line for the help page
  std::string_view extension = {};  ///< of its file; empty: the name
  std::string_view companion = {};  ///< extension of a second file beside it; empty: none
  bool velocity = false;            ///< whether it contains velocities
  bool attitude = false;            ///< whether it contains attitudes
  bool covariance = false;          ///< whether it makes no sense without covariances
  bool projected = false;           ///< whether it needs a projection
  std::function<std::unique_ptr<TrajectoryWriter>(const std::filesystem::path&, const WriterOptions&)> make = {};
};

/// The formats, in an explicit table. To add one, write a file under src/io/writers and a line in trajectory_formats.cpp.
/// Axes, times and the last digit of each stand in docs/outputs.md.
[[nodiscard]] const std::vector<TrajectoryFormat>& trajectory_formats();
/// @throws std::invalid_argument  no such format
[[nodiscard]] const TrajectoryFormat& trajectory_format(std::string_view name);
/// "trajectory.nav": the name of a file of a format.
[[nodiscard]] std::string file_of(std::string_view stem, const TrajectoryFormat& format);
/// The second file of a format: the same name with the other extension.
[[nodiscard]] std::filesystem::path companion_of(const std::filesystem::path& file, std::string_view companion);

/// GNSS fixes as RTKLIB `.pos` with signed-root covariances; reads back to the printed digits (1e-9 deg, 1e-4 m, 1e-5 m of sd;
/// if a sd is below 1e-4 m, enough digits to give it four, down to a nanometre).
void write_gnss_pos(const std::filesystem::path& path, const record::GnssRecording& gnss);
/// Whether the times of a table have their GPS week beside them: gps_week and sow_s in place of time_s.
enum class WeekColumn { kWithout, kWith };
/// IMU as CSV with the default header: mean rates over each interval.
void write_imu_csv(const std::filesystem::path& path, const record::ImuRecording& imu, WeekColumn week = WeekColumn::kWithout);
/// GNSS fixes as CSV with the default header, times with their week; velocities and numbers of satellites if every fix
/// has them. Correlations between components are left out.
void write_gnss_csv(const std::filesystem::path& path, const record::GnssRecording& gnss);
/// GNSS fixes as CSV in a projected CRS: week, second of week, easting, northing, height, convergence, standard deviations
/// along the axes of the grid, quality.
void write_gnss_grid(const std::filesystem::path& path, const record::GnssRecording& gnss, const Projection& projection);
/// GNSS fixes as a layer `fixes` of points in a new GeoPackage.
/// @param projection  of the coordinates; null: WGS 84 with ellipsoidal heights
void write_gnss_geopackage(const std::filesystem::path& path, const record::GnssRecording& gnss, const Projection* projection);
/// Adds layers `fixes` and `events` to a GeoPackage that a trajectory was written to: points with time, quality, standard
/// deviations, and the attitude of a device. An empty list makes a layer without features.
/// @param states  null: no layer of events
void add_to_geopackage(const std::filesystem::path& path, const std::vector<record::GnssFix>& fixes,
                       const std::vector<record::MarkedState>* states, const Projection* projection);
/// Time marks as CSV: gps_week, sow_s, sd_s (empty: not stated), channel, edge, count, id.
void write_time_marks_csv(const std::filesystem::path& path, const record::TimeMarkRecording& marks);
/// A bag of ROS 2 as MCAP: the IMU as sensor_msgs/msg/Imu on /imu, mean rates and specific forces over each interval in the
/// axes of the recording, without attitude; positions as sensor_msgs/msg/NavSatFix on /fix with their covariance. Stamps are
/// POSIX times, to 1 ns. Not carried: temperatures, velocities, numbers of satellites; float and fixed ambiguities both become
/// ground-based augmentation.
/// @param imu, gnss  null: none
/// @throws OutputError
void write_mcap(const std::filesystem::path& path, const record::ImuRecording* imu, const record::GnssRecording* gnss);
/// First component of an aiding sensor's samples as CSV: gps_week, sow_s and a column of that name.
void write_aid_csv(const std::filesystem::path& path, const record::AidRecording& aid, std::string_view column);

}  // namespace coast::io
