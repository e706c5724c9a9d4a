#pragma once
// Reads YAML files into the configuration tree.

#include <filesystem>
#include <string>

#include "coast/config/node.hpp"

namespace coast::io {

/// Reads a configuration file. Its top level must be a map; paths in it are relative to its folder.
///
/// The part of YAML 1.2 used in configurations: one document, maps, lists and single values. Errors, with their line: keys that
/// appear twice in a map, aliases, tags, keys that are not single values, more than 64 levels, more than 200 000 nodes, more
/// than 16 MiB, control characters (a binary file).
/// @throws InputError  the file is missing, not readable, a directory, empty, or one of the above
[[nodiscard]] config::Node load_yaml(const std::filesystem::path& path);

/// The same from text. `name` is the file name in messages; paths are relative to its folder.
[[nodiscard]] config::Node parse_yaml(const std::string& text, const std::string& name);

}  // namespace coast::io
