#pragma once
// Chooses the format of a file: by name, or by content.

#include <fmt/format.h>

#include <filesystem>

#include "coast/config/node.hpp"
#include "coast/io/input.hpp"
#include "coast/io/registry.hpp"
#include "coast/record/error.hpp"
#include "file_kind.hpp"

namespace coast::io {

/// The start of a file, as formats are given it to recognise.
[[nodiscard]] inline FileHead head_of(const std::filesystem::path& file) {
  FileHead head{file.string(), read_head(file, 4096)};
  if (head.path.size() > 3 && head.path.ends_with(".gz")) head.path.resize(head.path.size() - 3);
  return head;
}

/// The format other than RINEX that recognises a file and has this reader; null if none does.
template <class Reader>
const Format* format_beside_rinex(const std::filesystem::path& file, Reader Format::*reader) {
  const FileHead head = head_of(file);
  for (const Format& f : formats())
    if (f.*reader && f.sniff && f.sniff(head)) return &f;
  return nullptr;
}

/// @param reader the member of Format that must be set  @param what "an IMU", for messages
template <class Reader>
const Format& format_for(const std::filesystem::path& file, const std::string& name, Reader Format::*reader,
                         std::string_view what) {
  std::vector<std::string> names;
  for (const Format& f : formats())
    if (f.*reader) names.emplace_back(f.name);
  if (name != "auto") {
    for (const Format& f : formats())
      if (f.name == name && f.*reader) return f;
    const std::string near = config::nearest(name, names);
    throw InputError({file.string(), 0, fmt::format("format \"{}\" for {} file", name, what),
                      fmt::format("auto, {}", fmt::join(names, ", ")),
                      near.empty() ? "" : fmt::format("Do you mean {}?", near)});
  }
  const FileHead head = head_of(file);
  for (const Format& f : formats())
    if (f.*reader && f.sniff && f.sniff(head)) return f;
  refuse_other_kind(file, FileKind::Content::kOther, fmt::format("{} file", what));
  throw InputError({file.string(), 0, fmt::format("not recognised as {} file", what),
                    fmt::format("one of: {}", fmt::join(names, ", ")), "Name the format with `format:`."});
}

}  // namespace coast::io
