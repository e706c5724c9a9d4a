#pragma once
// Determines for which job a configuration file is.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "coast/config/node.hpp"

namespace coast::jobs {

/// @param command  coast command that will read the file
/// @throws InputError  the file is of another kind, by its schema name or by its keys; files of unknown kind are accepted
void require_kind(const std::filesystem::path& file, std::string_view command);
void require_kind(const config::Node& root, std::string_view command);

/// Whether a YAML file names this schema, "coast.array_study/".
[[nodiscard]] bool names_schema(const std::filesystem::path& file, std::string_view schema);
[[nodiscard]] bool names_schema(const config::Node& root, std::string_view schema);

/// The word of `known` nearest to a word that is not among them; empty if none is near.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace coast::jobs
