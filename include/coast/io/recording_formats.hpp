#pragma once
// Formats in which coast writes recordings: what `coast convert` makes of receivers' own files.

#include <filesystem>
#include <string_view>
#include <vector>

#include "coast/io/contents.hpp"
#include "coast/io/projection.hpp"

namespace coast::io {

/// One file of a format.
struct RecordingPart {
  std::string_view extension;            ///< in place of that of the output's name
  std::string_view what;                 ///< "observations"
  bool (*present)(const FileContents&);  ///< whether there is something to write
  /// @param projection  not null for formats of a map  @throws OutputError
  void (*write)(const std::filesystem::path&, const FileContents&, const Projection* projection);
};

struct RecordingFormat {
  std::string_view name;         ///< as in `--to`
  std::string_view description;  ///< one line for the help page
  std::vector<RecordingPart> parts;
};

/// The formats, in an explicit table. To add one, write a line here and its writer beside the others (writers.hpp).
[[nodiscard]] const std::vector<RecordingFormat>& recording_formats();

}  // namespace coast::io
