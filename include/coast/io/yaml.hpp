#pragma once
// YAML files into the configuration tree.

#include <filesystem>
#include <string>

#include "coast/config/node.hpp"

namespace coast::io {

/// Reads a configuration file. Its top must be a map; relative paths in it count from its folder.
///
/// YAML 1.2 as people write configurations: one document, maps, lists and single values. Refused with their line: keys that
/// appear twice in a map, anchors' aliases, tags, keys that are not single values, more than 64 levels, more than 200 000
/// nodes, more than 16 MiB, control characters (a binary file).
/// @throws InputError  the file is missing, not readable, a directory, empty, or one of the above
[[nodiscard]] config::Node load_yaml(const std::filesystem::path& path);

/// The same from text. `name` stands for the file in messages, and its folder is where relative paths count from.
[[nodiscard]] config::Node parse_yaml(const std::string& text, const std::string& name);

}  // namespace coast::io
