#pragma once
// A configuration file that belongs to another subcommand.

#include <filesystem>
#include <string_view>

namespace coast::cli {

/// @param expected  e.g. "coast.run/1"
/// @throws InputError  the file names another known schema; a file without one is let through
void require_schema(const std::filesystem::path& file, std::string_view expected);

}  // namespace coast::cli
