#pragma once
// The formats, in an explicit table: a new one is a file under src/io/formats and a line in registry.cpp.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/io/gnss.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/reference.hpp"

namespace coast::io {

/// The begin of a file, decompressed, for recognising it.
struct FileHead {
  std::string path;  ///< without ".gz"
  std::string text;  ///< at most 4096 bytes
};

/// One file format. What it can carry shows in which readers are set.
struct Format {
  using Near = std::optional<geo::GpsTime>;
  std::string_view name;                       ///< as in `format:`
  std::string_view description;                ///< one line for the help page
  std::function<bool(const FileHead&)> sniff;  ///< by content; empty: only by name
  std::function<record::ImuRecording(const ImuFileOptions&, Near)> read_imu;
  std::function<record::GnssRecording(const GnssFileOptions&, Near)> read_gnss;
  std::function<record::Trajectory(const ReferenceFileOptions&, Near)> read_reference;
};

/// All formats, the most particular first: the first that recognises a file reads it.
[[nodiscard]] const std::vector<Format>& formats();

}  // namespace coast::io
