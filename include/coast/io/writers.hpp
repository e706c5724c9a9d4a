#pragma once
// Files that coast writes. Each is written under a temporary name in the same folder and renamed when complete, so that a crash
// or a full disk leaves no partial file under the final name.

#include <cstdint>
#include <filesystem>
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
#include "coast/record/trajectory.hpp"

namespace coast::io {

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

/// `.nav`: week sow lat lon h vn ve vd roll pitch yaw. 1e-11 deg (1 um), 1e-5 m, 1e-6 m/s, 1e-9 deg; some 1 million epochs/s.
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_nav_writer(const std::filesystem::path& path);
/// CSV with header: gps_week, sow_s, position, velocity, attitude; standard deviations (N, E, D; roll, pitch, yaw) and
/// correlations of position, velocity and attitude errors.
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_csv_writer(const std::filesystem::path& path);
/// SBET (136-byte records of doubles, rad, little endian). Acceleration (without gravity) and angular rate, both with respect
/// to the Earth and in body axes, are those of `motion`; the wander angle is zero: the attitude's yaw is the true heading.
/// `smrmsg` is the file of standard deviations (80-byte records).
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_sbet_writer(const std::filesystem::path& sbet,
                                                                 const std::filesystem::path& smrmsg);
/// RTKLIB `.pos` (GPST calendar, degrees, ellipsoidal), positions and velocities with signed-root covariances. Q, ns, age and
/// ratio are those of `gnss`; without GNSS, Q = 7 (dead reckoning) and ns = 0.
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_pos_writer(const std::filesystem::path& path);
/// KML tracks with UTC times, one track for each stretch of equal GNSS quality, coloured by quality; thinned to steps of at
/// least `min_step_m`. Altitudes are above mean sea level, as viewers expect; if the geoid is not known they are above the
/// ellipsoid, the tracks are clamped to the ground, and the description states this.
/// @param geoid_height_m  height of the geoid above the height reference of the trajectory, m
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_kml_writer(const std::filesystem::path& path, std::string_view name,
                                                                std::optional<double> geoid_height_m, double min_step_m = 1.0);

/// One of `output.formats`: nav | csv | sbet | pos | kml; the extension is added to `stem`.
/// @throws std::invalid_argument  another name
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_trajectory_writer(std::string_view format,
                                                                       const std::filesystem::path& stem,
                                                                       std::optional<double> geoid_height_m = {});
/// The names that make_trajectory_writer accepts.
[[nodiscard]] const std::vector<std::string_view>& trajectory_formats();

/// GNSS fixes as RTKLIB `.pos` with signed-root covariances; reads back to the printed digits (1e-9 deg, 1e-4 m, 1e-5 m of sd;
/// if a sd is below 1e-4 m, enough digits to give it four, down to a nanometre).
void write_gnss_pos(const std::filesystem::path& path, const record::GnssRecording& gnss);
/// IMU as CSV with the default header: mean rates over each interval.
void write_imu_csv(const std::filesystem::path& path, const record::ImuRecording& imu);
/// First component of an aiding sensor's samples as CSV: gps_week, sow_s and a column of that name.
void write_aid_csv(const std::filesystem::path& path, const record::AidRecording& aid, std::string_view column);

}  // namespace coast::io
