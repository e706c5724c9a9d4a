#pragma once
// Files that are installed with the program: error models, scenarios, studies, run files.

#include <filesystem>
#include <optional>

namespace coast::io {

/// A file of the installed folder share/coast by its name there, `configs/..`: where a path ends with such a name and there is
/// no file, it means the installed one, so that what the documentation writes holds without a clone. The folder is found beside
/// that of the program that runs (bin/../share/coast).
/// @param path  as somebody wrote it, or joined to a folder
/// @return  none: nothing of that name is installed
[[nodiscard]] std::optional<std::filesystem::path> shipped_file(const std::filesystem::path& path);

}  // namespace coast::io
