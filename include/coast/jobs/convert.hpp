#pragma once
// A trajectory, or what a receiver recorded, in another format.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coast/io/contents.hpp"
#include "coast/io/projection.hpp"
#include "coast/jobs/job.hpp"

namespace coast::jobs {

struct ConvertConfig {
  std::filesystem::path input;  ///< any file of one kind, or of messages, that coast reads
  std::filesystem::path output;
  std::string format;                          ///< one of io::trajectory_formats() or io::recording_formats()
  std::optional<int> gps_week;                 ///< of files with seconds of week only
  std::optional<double> rate_hz;               ///< of trajectories; absent: every epoch
  std::shared_ptr<io::Projection> projection;  ///< for formats with coordinates of a map; null: none
  std::optional<double> geoid_height_m;        ///< geoid above the ellipsoid, for formats with heights above mean sea level
};

/// @param format  empty: by the extension of `output`
/// @throws InputError  no format of that name; the output is the input
[[nodiscard]] ConvertConfig read_convert(const std::filesystem::path& input, const std::filesystem::path& output,
                                         const std::string& format);

/// @throws InputError  the file cannot be read, or has nothing that the format can hold; a format of a map has no projection,
///                     or no transformation leads to it from the place of the file
[[nodiscard]] io::FileContents convert(const ConvertConfig& config, const Progress& progress);

/// All files that the format can consist of.
[[nodiscard]] std::vector<std::string> files_of(const ConvertConfig& config);
/// Writes those for which the input has something. Of trajectories, standard deviations and GNSS quality are not among what is
/// read, and are left out; rates and accelerations of SBET are differences of the states.
void write(const ConvertConfig& config, const io::FileContents& contents, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const ConvertConfig& config, const io::FileContents& contents,
                               const std::filesystem::path& folder);

[[nodiscard]] std::vector<std::string> convert_format_names();
/// The formats that are written, one a line, for the help page.
[[nodiscard]] std::string convert_formats(const std::string& indent);

}  // namespace coast::jobs
