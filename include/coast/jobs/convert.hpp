#pragma once
// A trajectory in another format.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/jobs/job.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::jobs {

struct ConvertConfig {
  std::filesystem::path input;  ///< .nav, CSV or SBET
  std::filesystem::path output;
  std::string format;                    ///< one of io::trajectory_formats()
  std::optional<int> gps_week;           ///< of files with seconds of week only
  std::optional<double> rate_hz;         ///< absent: every epoch
  std::optional<double> geoid_height_m;  ///< geoid above the ellipsoid, for formats with heights above mean sea level
};

/// @param format  empty: by the extension of `output`
/// @throws InputError  no format of that name; the output is the input
[[nodiscard]] ConvertConfig read_convert(const std::filesystem::path& input, const std::filesystem::path& output,
                                         const std::string& format);

/// @throws InputError  the file cannot be read, or lacks what the format contains: velocity, attitude, standard deviations
[[nodiscard]] record::Trajectory convert(const ConvertConfig& config, const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const ConvertConfig& config);
/// Standard deviations and GNSS quality are not among what is read of a trajectory, and are left out; rates and accelerations
/// of SBET are differences of the states.
void write(const ConvertConfig& config, const record::Trajectory& trajectory, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const ConvertConfig& config, const record::Trajectory& trajectory,
                               const std::filesystem::path& folder);

[[nodiscard]] std::vector<std::string> convert_format_names();
/// The formats that are written, one a line, for the help page.
[[nodiscard]] std::string convert_formats(const std::string& indent);

}  // namespace coast::jobs
