#pragma once
// Recognises the actual kind of a file of unexpected kind: for messages.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "coast/record/error.hpp"

namespace coast::io {

struct FileKind {
  enum class Content { kOther, kImu, kPositions, kYaml, kRinex, kOrbits };
  std::string name;  ///< "an NMEA file"
  std::string what_to_do;
  Content content = Content::kOther;
};

/// Neither a configuration file nor a table.
[[nodiscard]] inline bool is_no_table(FileKind::Content content) {
  using enum FileKind::Content;
  return content == kOther || content == kRinex || content == kOrbits;
}

/// The kind according to the first bytes of a file; none if they are not conclusive.
[[nodiscard]] std::optional<FileKind> file_kind(std::string_view head);

/// For use after a read error: reports the kind of the file if this is the cause, and returns if it is not known to be of
/// another kind.
/// @param own  the assumed kind, which is accepted
/// @throws InputError  "this is a .. file"
void refuse_other_kind(const std::filesystem::path& file, FileKind::Content own, std::string_view expected);

/// Returns the result of `read`; if it fails on a file of another kind, reports this.
template <typename Read>
auto read_as(const std::filesystem::path& file, FileKind::Content own, std::string_view expected, Read&& read) {
  try {
    return std::forward<Read>(read)();
  } catch (const InputError&) {
    refuse_other_kind(file, own, expected);
    throw;
  }
}

}  // namespace coast::io
