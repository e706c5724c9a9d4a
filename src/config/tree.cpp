#include "tree.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

#include "coast/config/builder.hpp"

namespace coast::config {

namespace {

constexpr std::string_view kDataVariable = "${COAST_DATA}";

TreeEntry entry(Kind kind, std::string key, std::string text, long line) {
  TreeEntry e;
  e.kind = kind;
  e.key = std::move(key);
  e.text = std::move(text);
  e.line = line;
  return e;
}

}  // namespace

std::size_t TreeData::add(std::size_t parent, TreeEntry entry) {
  const std::size_t index = entries.size();
  entry.parent = parent;
  entries.push_back(std::move(entry));
  if (index != parent) entries[parent].children.push_back(index);
  return index;
}

const TreeEntry* TreeData::child(std::size_t map, std::string_view key) const {
  for (std::size_t index : entries[map].children) {
    if (entries[index].key == key) return &entries[index];
  }
  return nullptr;
}

std::string TreeData::path_of(std::size_t index) const {
  if (index == 0) return {};
  const TreeEntry& e = entries[index];
  const TreeEntry& parent = entries[e.parent];
  const std::string above = path_of(e.parent);
  if (parent.kind != Kind::kList) return above.empty() ? e.key : above + "." + e.key;
  std::size_t place = 0;
  while (parent.children[place] != index) ++place;
  return fmt::format("{}[{}]", above, place);
}

std::string TreeData::source_of(std::size_t index) const {
  const std::string name = file.string();
  return entries[index].line > 0 ? fmt::format("{}:{}", name, entries[index].line) : name;
}

InputError TreeData::error(std::size_t index, std::string_view found, std::string_view expected,
                           std::string_view what_to_do) const {
  const std::string key = path_of(index);
  return InputError({file.string(), entries[index].line, key.empty() ? std::string(found) : fmt::format("{}: {}", key, found),
                     std::string(expected), std::string(what_to_do)});
}

std::filesystem::path resolve_path(const TreeData& data, std::size_t index) {
  const std::string& text = data.entries[index].text;
  if (text.empty()) throw data.error(index, "an empty path", "the name of a file or folder", "");
  if (text.rfind(kDataVariable, 0) == 0) {
    const char* folder = std::getenv("COAST_DATA");
    if (folder == nullptr || *folder == '\0') {
      throw data.error(index, fmt::format("'{}', but COAST_DATA is not set", text), "the folder of the recordings in it",
                       "Set the environment variable COAST_DATA, or write the path out.");
    }
    return (std::filesystem::absolute(folder).string() + text.substr(kDataVariable.size()));
  }
  if (text.find("${") != std::string::npos) {
    throw data.error(index, fmt::format("'{}'", text), "a path without variables",
                     "Only ${COAST_DATA} is expanded, and only at the start of a path.");
  }
  return std::filesystem::absolute(data.file.parent_path() / text).lexically_normal();
}

TreeBuilder::TreeBuilder(std::filesystem::path file) : data_(std::make_shared<TreeData>()) {
  data_->file = std::move(file);
}

namespace {

TreeBuilder::Id add_root(TreeData& data, Kind kind, long line) {
  if (!data.entries.empty()) throw std::invalid_argument("the tree has a root already");
  return data.add(0, entry(kind, "", "", line));
}

TreeBuilder::Id add_child(TreeData& data, TreeBuilder::Id parent, TreeEntry child) {
  const Kind kind = data.entries.at(parent).kind;
  if (kind != Kind::kMap && kind != Kind::kList) throw std::invalid_argument("the parent of a node is a map or a list");
  return data.add(parent, std::move(child));
}

}  // namespace

TreeBuilder::Id TreeBuilder::root_map(long line) {
  return add_root(*data_, Kind::kMap, line);
}
TreeBuilder::Id TreeBuilder::root_list(long line) {
  return add_root(*data_, Kind::kList, line);
}

TreeBuilder::Id TreeBuilder::add_map(Id parent, std::string key, long line) {
  return add_child(*data_, parent, entry(Kind::kMap, std::move(key), "", line));
}
TreeBuilder::Id TreeBuilder::add_list(Id parent, std::string key, long line) {
  return add_child(*data_, parent, entry(Kind::kList, std::move(key), "", line));
}
TreeBuilder::Id TreeBuilder::add_scalar(Id parent, std::string key, std::string text, long line) {
  return add_child(*data_, parent, entry(Kind::kScalar, std::move(key), std::move(text), line));
}
TreeBuilder::Id TreeBuilder::add_table(Id parent, std::string key, std::shared_ptr<const record::Table> table) {
  TreeEntry added = entry(Kind::kScalar, std::move(key), table->name, 0);
  added.table = std::move(table);
  return add_child(*data_, parent, std::move(added));
}
TreeBuilder::Id TreeBuilder::add_null(Id parent, std::string key, long line) {
  return add_child(*data_, parent, entry(Kind::kNull, std::move(key), "", line));
}

Node TreeBuilder::finish() {
  if (data_ == nullptr || data_->entries.empty()) throw std::invalid_argument("a tree without a root");
  return make_root(std::move(data_));
}

}  // namespace coast::config
