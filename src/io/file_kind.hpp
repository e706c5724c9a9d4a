#pragma once
// What a file is that is not what it was taken for: for messages.

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

/// What is neither a configuration file nor a table.
[[nodiscard]] inline bool is_no_table(FileKind::Content content) {
  using enum FileKind::Content;
  return content == kOther || content == kRinex || content == kOrbits;
}

/// The kind that the first bytes of a file show; nothing where they show none.
[[nodiscard]] std::optional<FileKind> file_kind(std::string_view head);

/// For the way of an error: says what the file is where that is the reason, and returns where it is not known to be another
/// kind.
/// @param own  what the file was taken for, and may be
/// @throws InputError  "this is a .. file"
void refuse_other_kind(const std::filesystem::path& file, FileKind::Content own, std::string_view expected);

/// What `read` returns; where it fails on a file of another kind than its own, says so.
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
