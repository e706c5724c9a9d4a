#pragma once
// The configuration tree in memory. It records which keys were read, so that an unknown key is an error that names the nearest
// known one, and every value used, so that a run can be repeated from its resolved file. No file is opened here: io/yaml.hpp
// parses a file into a tree.

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/record/error.hpp"
#include "coast/record/table.hpp"

namespace coast::config {

struct TreeData;  // the parsed tree and the record of the keys and values read

/// A view of one node of the tree; cheap to copy. Reading writes to this shared record: only one thread may read a tree. Every
/// getter throws InputError with file, line and key.
class Node {
 public:
  Node();  ///< an empty map that belongs to no file: every `find` is empty, every default is used

  [[nodiscard]] bool is_map() const;
  [[nodiscard]] bool is_list() const;
  [[nodiscard]] bool is_scalar() const;

  /// Required child.  @throws InputError the key is missing (names the map's line, and the nearest key not yet read)
  [[nodiscard]] Node at(std::string_view key) const;
  [[nodiscard]] std::optional<Node> find(std::string_view key) const;
  /// Optional child map. If absent: an empty one, whose defaults are written under `key` in the resolved tree.
  /// @throws InputError the key is there and is not a map
  [[nodiscard]] Node section(std::string_view key) const;
  [[nodiscard]] std::vector<Node> items() const;        ///< of a list
  [[nodiscard]] std::vector<std::string> keys() const;  ///< of a map; does not mark them as read

  // Scalars of this node.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] double number() const;  ///< finite
  [[nodiscard]] long integer() const;
  [[nodiscard]] bool flag() const;                    ///< true | false
  [[nodiscard]] Eigen::Vector3d vector3() const;      ///< a list of three finite numbers
  [[nodiscard]] std::vector<double> numbers() const;  ///< a list of finite numbers
  /// A path, relative to the file that contains it; only ${COAST_DATA} is expanded.
  [[nodiscard]] std::filesystem::path path() const;
  /// Numbers in place of the file that path() names; null for a file.
  [[nodiscard]] std::shared_ptr<const record::Table> table() const;

  // Optional children with defaults; a default that is used is recorded.
  [[nodiscard]] double number(std::string_view key, double fallback) const;
  [[nodiscard]] long integer(std::string_view key, long fallback) const;
  [[nodiscard]] bool flag(std::string_view key, bool fallback) const;
  [[nodiscard]] std::string text(std::string_view key, std::string_view fallback) const;
  [[nodiscard]] Eigen::Vector3d vector3(std::string_view key, const Eigen::Vector3d& fallback) const;
  /// One of `names`; returns its index.  @throws InputError another word (lists the names, the nearest first)
  [[nodiscard]] std::size_t choice(std::string_view key, const std::vector<std::string_view>& names,
                                   std::size_t fallback) const;

  /// This scalar as one of `names`; returns its index.  @throws InputError another word, or not a scalar
  [[nodiscard]] std::size_t choice(const std::vector<std::string_view>& names) const;

  /// A number in [low, high].  @throws InputError outside (states the range)
  [[nodiscard]] double number_within(std::string_view key, double fallback, double low, double high) const;

  /// The error to throw for this node: "file:line: key: found, expected ... . what to do".
  [[nodiscard]] InputError error(std::string_view found, std::string_view expected, std::string_view what_to_do = "") const;
  [[nodiscard]] const std::filesystem::path& file() const;  ///< of the whole tree, as it was named
  [[nodiscard]] std::string where() const;                  ///< "run.yaml:12: imu.rate_hz"

  /// Records a value (YAML text) that the run estimated or derived under this map. In the resolved file it is a comment: it
  /// shows what was found, and a run from the file estimates it again and gets the same numbers.
  void note_estimated(std::string_view key, std::string_view value) const;

  /// Throws for the first key of the tree below this node that was never read.
  void refuse_unasked() const;
  /// The resolved tree below this node as YAML: every value used, with "# default", "# file:line" or "# estimated".
  /// Given values keep their text and defaults have the shortest text that reads back to the same double, so a run from
  /// this file gets identical numbers. Paths are written absolute, or as given where they start with ${COAST_DATA}: the
  /// file may be written anywhere.
  [[nodiscard]] std::string resolved_yaml() const;

 private:
  friend struct TreeData;
  friend Node make_root(std::shared_ptr<TreeData> data);
  std::shared_ptr<TreeData> data_;
  std::size_t index_ = 0;
};

/// The word of `known` nearest to `word` by edit distance (Damerau-Levenshtein); empty if none is near (distance > 1/2 length).
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace coast::config
