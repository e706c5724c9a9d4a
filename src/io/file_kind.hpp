#pragma once
// What a file is that is not what it was taken for: for messages.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace coast::io {

struct FileKind {
  enum class Content { kOther, kImu, kPositions, kYaml };
  std::string name;  ///< "an NMEA file"
  std::string what_to_do;
  Content content = Content::kOther;
};

/// The kind that the first bytes of a file show; nothing where they show none.
[[nodiscard]] std::optional<FileKind> file_kind(std::string_view head);

/// For the way of an error: says what the file is where that is the reason, and returns where it is not known to be another
/// kind.
/// @param own  what the file was taken for, and may be
/// @throws InputError  "this is a .. file"
void refuse_other_kind(const std::filesystem::path& file, FileKind::Content own, std::string_view expected);

}  // namespace coast::io
