#pragma once
// Used by a parser to build a tree: node by node, each with its line. Independent of the file format.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "coast/config/node.hpp"

namespace coast::config {

/// Builds a tree from the top down. Every id passed in was returned by this builder before.
class TreeBuilder {
 public:
  using Id = std::size_t;

  /// @param file names the tree in messages; relative paths in it are relative to its folder
  explicit TreeBuilder(std::filesystem::path file);

  /// The top of the tree: exactly one of these, first.
  Id root_map(long line);
  Id root_list(long line);

  /// @param parent a map or a list  @param key of the map; empty in a list
  /// @throws std::invalid_argument the parent is a scalar
  Id add_map(Id parent, std::string key, long line);
  Id add_list(Id parent, std::string key, long line);
  Id add_scalar(Id parent, std::string key, std::string text, long line);
  /// Numbers in memory where a file is expected. Its name stands in the resolved tree: from there it cannot be read again.
  Id add_table(Id parent, std::string key, std::shared_ptr<const record::Table> table);
  /// A key without a value ("key:" or "key: null"): reading it is an error.
  Id add_null(Id parent, std::string key, long line);

  /// The finished tree's root; the builder is empty afterwards.
  [[nodiscard]] Node finish();

 private:
  std::shared_ptr<TreeData> data_;
};

}  // namespace coast::config
