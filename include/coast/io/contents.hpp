#pragma once
// What a file holds, whatever its kind.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/navigation.hpp"
#include "coast/record/observation.hpp"
#include "coast/record/time_mark.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::io {

/// Messages of one kind in a file that consists of messages.
struct MessageCount {
  std::string name;  ///< "UBX-RXM-RAWX", "NMEA GGA", "sensor_combined 0"
  long number = 0;
};

/// Everything that the readers find in a file. What it does not hold is absent.
struct FileContents {
  std::string source;
  std::string format;                  ///< "UBX of u-blox receivers"
  std::vector<MessageCount> messages;  ///< the most frequent first; empty: not a file of messages
  std::optional<record::ImuRecording> imu;
  std::optional<record::GnssRecording> gnss;
  std::optional<record::ObservationRecording> observations;
  std::optional<record::NavigationRecording> navigation;
  std::optional<record::Trajectory> trajectory;
  std::optional<record::TimeMarkRecording> marks;
  std::vector<std::string> refusals;  ///< what readers of this format did not find, or could not read
};

/// Reads a file with every reader of the first format of the formats' table that recognises it and finds something, or as
/// RINEX. Columns of a table must have the default names.
/// @param gps_week  of files with seconds of week only
/// @throws InputError  the file is of no kind that is read here, nothing in it can be read, or it has seconds of week and no
///                     week
[[nodiscard]] FileContents read_contents(const std::filesystem::path& file, std::optional<int> gps_week = std::nullopt);

}  // namespace coast::io
