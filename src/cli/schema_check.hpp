#pragma once
// A configuration file that belongs to another subcommand.

#include <filesystem>
#include <string_view>

namespace coast::cli {

/// @param command  of coast, that is to read the file
/// @throws InputError  the file is of another kind, by the schema that it names or by its keys; what is not known is let
/// through
void require_kind(const std::filesystem::path& file, std::string_view command);

}  // namespace coast::cli
