#pragma once
// Files that coast writes. Each is written under a temporary name beside its own and renamed when whole, so that a crash or a
// full disk leaves no half file under a final name.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/record/error.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::io {

/// A file that appears whole or not at all. Where the target exists and is no regular file (a pipe, a device), it is written
/// directly. In a folder of results (results_folder.hpp) it replaces only what coast wrote.
class AtomicFile {
 public:
  /// @throws OutputError  the folder is missing or not writable; names the path
  /// @throws InputError   the file is there and is not coast's, or was read by this job
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

/// Removes what is half written and ends the process: for a signal, from a thread of its own and not from a handler.
[[noreturn]] void exit_without_unfinished_files(int status);

/// Writes a whole text at once.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Takes a trajectory epoch by epoch, in order of time.
class TrajectoryWriter {
 public:
  virtual ~TrajectoryWriter() = default;
  /// @throws OutputError
  virtual void write(const record::TrajectoryEpoch& epoch) = 0;
  /// Makes the file appear. Without it nothing is left behind.  @throws OutputError
  virtual void close() = 0;
};

/// `.nav`: week sow lat lon h vn ve vd roll pitch yaw. 1e-11 deg (1 um), 1e-5 m, 1e-6 m/s, 1e-9 deg; some 1 million epochs/s.
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_nav_writer(const std::filesystem::path& path);
/// CSV with header: gps_week, sow_s, position, velocity, attitude; standard deviations (N, E, D; roll, pitch, yaw) and
/// correlations of position, velocity and attitude errors.
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_csv_writer(const std::filesystem::path& path);
/// SBET (136-byte records of doubles, rad, little endian). Acceleration (without gravity) and angular rate, both against the
/// Earth and in body axes, are those of `motion`; the wander angle is zero: the attitude's yaw is the true heading. With
/// `smrmsg` the file of standard deviations beside it (80-byte records).
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_sbet_writer(const std::filesystem::path& sbet,
                                                                 const std::filesystem::path& smrmsg);
/// RTKLIB `.pos` (GPST calendar, degrees, ellipsoidal), positions and velocities with signed-root covariances. Q, ns, age and
/// ratio are those of `gnss`; where there was none, Q = 7 (dead reckoning) and ns = 0.
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_pos_writer(const std::filesystem::path& path);
/// KML tracks with UTC times, a track for each stretch of one GNSS quality, in its colour; thinned to steps of at least
/// `min_step_m`. Altitudes are above mean sea level, as viewers take them; where the geoid is not known they are above the
/// ellipsoid, the tracks are clamped to the ground, and the description says so.
/// @param geoid_height_m  of the geoid above what the trajectory's heights count from, m
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_kml_writer(const std::filesystem::path& path, std::string_view name,
                                                                std::optional<double> geoid_height_m, double min_step_m = 1.0);

/// One of `output.formats`: nav | csv | sbet | pos | kml; the extension is added to `stem`.
/// @throws std::invalid_argument  another name
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_trajectory_writer(std::string_view format,
                                                                       const std::filesystem::path& stem,
                                                                       std::optional<double> geoid_height_m = {});
/// The names that make_trajectory_writer knows.
[[nodiscard]] const std::vector<std::string_view>& trajectory_formats();

/// GNSS fixes as RTKLIB `.pos` with signed-root covariances; reads back to the digits printed (1e-9 deg, 1e-4 m, 1e-5 m of sd;
/// of a fix with a sd below 1e-4 m as many more as give it four digits, down to a nanometre).
void write_gnss_pos(const std::filesystem::path& path, const record::GnssRecording& gnss);
/// IMU as CSV with the default header: mean rates over each interval.
void write_imu_csv(const std::filesystem::path& path, const record::ImuRecording& imu);

}  // namespace coast::io
