#pragma once
// The file formats, in an explicit table. To add one, write a file under src/io/formats and a line in registry.cpp.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/io/contents.hpp"
#include "coast/io/gnss.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/reference.hpp"

namespace coast::io {

/// The start of a file, decompressed, for recognising the format.
struct FileHead {
  std::string path;  ///< without ".gz"
  std::string text;  ///< at most 4096 bytes
};

/// One file format. The readers that are set show what it can contain.
struct Format {
  using Near = std::optional<geo::GpsTime>;
  std::string_view name;                       ///< as in `format:`
  std::string_view description;                ///< one line for the help page
  std::function<bool(const FileHead&)> sniff;  ///< recognises the content; empty: chosen by name only
  std::function<record::ImuRecording(const ImuFileOptions&, Near)> read_imu;
  std::function<record::GnssRecording(const GnssFileOptions&, Near)> read_gnss;
  std::function<record::Trajectory(const ReferenceFileOptions&, Near)> read_reference;
  /// Formats beside RINEX only: what is no other format is read as RINEX.
  std::function<record::ObservationRecording(const std::filesystem::path&)> read_observations = {};
  std::function<record::NavigationRecording(const std::filesystem::path&)> read_navigation = {};
  std::function<record::TimeMarkRecording(const std::filesystem::path&)> read_time_marks = {};
  /// Formats that may not state the week: the same with a time less than half a week from the first epoch, if one is known.
  std::function<record::ObservationRecording(const std::filesystem::path&, Near)> read_observations_near = {};
  std::function<record::NavigationRecording(const std::filesystem::path&, Near)> read_navigation_near = {};
  /// Of a file that consists of messages: how many of which kind, the most frequent first.
  std::function<std::vector<MessageCount>(const std::filesystem::path&)> count_messages = {};
};

/// All formats, the most specific first: the first that recognises a file reads it.
[[nodiscard]] const std::vector<Format>& formats();

}  // namespace coast::io
