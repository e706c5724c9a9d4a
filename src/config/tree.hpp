#pragma once
// The tree of config::Node: an arena of entries, and the ledger of requested keys and their values.

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "coast/config/derived.hpp"
#include "coast/config/node.hpp"

namespace coast::config {

enum class Kind { kMap, kList, kScalar, kNull };

struct TreeEntry {
  Kind kind = Kind::kMap;
  std::string key;                                  // of the parent map; empty in a list and at the root
  std::string text;                                 // of a scalar
  std::shared_ptr<const record::Table> table = {};  // of a scalar that stands for a file
  long line = 0;                                    // 0: not from a file
  std::size_t parent = 0;
  std::vector<std::size_t> children;

  // Ledger.
  bool asked = false;
  bool is_path = false;                          // read by path(): written so that it resolves from any folder
  std::set<std::string> asked_keys;              // of a map, present or not
  std::map<std::string, std::string> defaults;   // of a map: absent key -> YAML text of the default used
  std::map<std::string, std::string> estimated;  // of a map: key -> YAML text
};

struct TreeData {
  std::filesystem::path file;
  std::vector<TreeEntry> entries;  // the root is entry 0

  std::size_t add(std::size_t parent, TreeEntry entry);
  [[nodiscard]] const TreeEntry* child(std::size_t map, std::string_view key) const;
  [[nodiscard]] std::size_t index_of(const TreeEntry& entry) const { return static_cast<std::size_t>(&entry - entries.data()); }
  [[nodiscard]] std::string path_of(std::size_t index) const;    // "outages[1].start_s"; empty at the root
  [[nodiscard]] std::string source_of(std::size_t index) const;  // "run.yaml:12"
  [[nodiscard]] InputError error(std::size_t index, std::string_view found, std::string_view expected,
                                 std::string_view what_to_do) const;

  // derived.hpp, for which a node shows its tree to nobody else.
  static Node with(const Node& root, const std::vector<Replacement>& replacements);
  static void mark_read(const Node& node);
  static std::vector<std::filesystem::path> paths_read(const Node& root);
  static std::string canonical(const Node& root, const std::function<std::string(const std::filesystem::path&)>& in_place_of,
                               const std::set<std::string>& without);
};

[[nodiscard]] Node make_root(std::shared_ptr<TreeData> data);

// The text of `path` with a leading ${COAST_DATA} expanded, from the folder of `file`.
[[nodiscard]] std::filesystem::path resolve_path(const TreeData& data, std::size_t index);

// Scalar as YAML: plain if that is safe in block and flow, else in double quotes.
[[nodiscard]] std::string yaml_text(std::string_view text);
[[nodiscard]] std::string yaml_text(double value);
[[nodiscard]] std::string yaml_text(const Eigen::Vector3d& value);

}  // namespace coast::config
