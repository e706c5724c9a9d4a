#pragma once
// A configuration that differs from another one in some keys, and what identifies a configuration: for many runs made from few
// files.

#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coast/config/node.hpp"

namespace coast::config {

/// A key of a map, by the maps that lead to it, and what stands there instead.
struct Replacement {
  std::vector<std::string> key;  ///< {"imu", "error_model"}; the maps before the last are created where they are missing
  std::optional<Node> value;     ///< a copy of this node, or nothing: the key is absent
};

/// A copy of a tree with other values. Nothing of the copy has been read; relative paths count from the folder of the file of
/// `root`, also those in the new values.
/// @throws InputError  a map that leads to a key is no map
[[nodiscard]] Node with(const Node& root, const std::vector<Replacement>& replacements);

/// A value alone, without file and line: for a replacement.
[[nodiscard]] Node value_of(const std::string& text);

/// Marks everything below a node as read: somebody else will check it.
void mark_read(const Node& node);

/// Every path that was read from a tree (Node::path), each once, sorted.
[[nodiscard]] std::vector<std::filesystem::path> paths_read(const Node& root);

/// Given values of a tree as text, the same for the same content: keys in alphabetical order, without comments and lines. A
/// path that was read is replaced.
/// @param in_place_of  of a path: what stands for it, such as a digest of the file
/// @param without      keys that are left out, as "imu.error_model"
[[nodiscard]] std::string canonical(const Node& root,
                                    const std::function<std::string(const std::filesystem::path&)>& in_place_of,
                                    const std::set<std::string>& without = {});

}  // namespace coast::config
