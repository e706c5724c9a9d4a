#include "coast/config/derived.hpp"

#include <algorithm>
#include <set>

#include "coast/config/builder.hpp"
#include "tree.hpp"

namespace coast::config {

namespace {

/// Copies entry `from` and what is below it to the end of `to`, without its ledger.
void copy(const TreeData& source, std::size_t from, TreeData& to, std::size_t parent, const std::string& key) {
  const TreeEntry& given = source.entries[from];
  TreeEntry entry;
  entry.kind = given.kind;
  entry.key = key;
  entry.text = given.text;
  entry.table = given.table;
  entry.line = given.line;
  const std::size_t at = to.add(parent, std::move(entry));
  for (const std::size_t child : given.children) copy(source, child, to, at, source.entries[child].key);
}

void remove_child(TreeData& data, std::size_t map, const std::string& key) {
  std::erase_if(data.entries[map].children, [&](std::size_t child) { return data.entries[child].key == key; });
}

/// The map that holds the last of the keys.
std::size_t map_before(TreeData& data, const std::vector<std::string>& key) {
  std::size_t map = 0;
  for (std::size_t i = 0; i + 1 < key.size(); ++i) {
    const TreeEntry* next = data.child(map, key[i]);
    if (next != nullptr && next->kind != Kind::kMap) throw data.error(data.index_of(*next), "no map", "a map of keys", "");
    if (next != nullptr) {
      map = data.index_of(*next);
      continue;
    }
    TreeEntry created;
    created.key = key[i];
    map = data.add(map, std::move(created));
  }
  return map;
}

/// A tree as text, with what stands for paths and without some keys.
class Canonical {
 public:
  Canonical(const TreeData& data, const std::function<std::string(const std::filesystem::path&)>& in_place_of,
            const std::set<std::string>& without)
      : data_(data), in_place_of_(in_place_of), without_(without) {}

  [[nodiscard]] std::string of(std::size_t index) const {
    const TreeEntry& entry = data_.entries[index];
    if (entry.kind == Kind::kNull) return "~";
    if (entry.kind == Kind::kScalar) return entry.is_path ? in_place_of_(resolve_path(data_, index)) : yaml_text(entry.text);
    std::vector<std::size_t> children = entry.children;
    const bool map = entry.kind == Kind::kMap;
    if (map) {
      std::erase_if(children, [this](std::size_t child) { return without_.contains(data_.path_of(child)); });
      std::ranges::sort(children, {}, [this](std::size_t child) -> const std::string& { return data_.entries[child].key; });
    }
    std::string text(1, map ? '{' : '[');
    for (const std::size_t child : children) {
      if (map) text += yaml_text(data_.entries[child].key) + ":";
      text += of(child) + ",";
    }
    return text + (map ? '}' : ']');
  }

 private:
  const TreeData& data_;
  const std::function<std::string(const std::filesystem::path&)>& in_place_of_;
  const std::set<std::string>& without_;
};

}  // namespace

Node TreeData::with(const Node& root, const std::vector<Replacement>& replacements) {
  auto data = std::make_shared<TreeData>();
  data->file = root.data_->file;
  copy(*root.data_, root.index_, *data, 0, "");
  for (const Replacement& replacement : replacements) {
    const std::size_t map = map_before(*data, replacement.key);
    remove_child(*data, map, replacement.key.back());
    if (replacement.value) copy(*replacement.value->data_, replacement.value->index_, *data, map, replacement.key.back());
  }
  return make_root(std::move(data));
}

namespace {

void mark(TreeData& data, std::size_t index) {
  data.entries[index].asked = true;
  for (const std::size_t child : data.entries[index].children) mark(data, child);
}

}  // namespace

void TreeData::mark_read(const Node& node) {
  mark(*node.data_, node.index_);
}

std::vector<std::filesystem::path> TreeData::paths_read(const Node& root) {
  std::set<std::filesystem::path> paths;
  for (std::size_t i = 0; i < root.data_->entries.size(); ++i)
    if (root.data_->entries[i].is_path) paths.insert(resolve_path(*root.data_, i));
  return {paths.begin(), paths.end()};
}

std::string TreeData::canonical(const Node& root, const std::function<std::string(const std::filesystem::path&)>& in_place_of,
                                const std::set<std::string>& without) {
  return Canonical(*root.data_, in_place_of, without).of(root.index_);
}

Node with(const Node& root, const std::vector<Replacement>& replacements) {
  return TreeData::with(root, replacements);
}

Node value_of(const std::string& text) {
  TreeBuilder builder{std::filesystem::path()};
  const TreeBuilder::Id list = builder.root_list(0);
  static_cast<void>(builder.add_scalar(list, "", text, 0));
  return builder.finish().items().front();
}

void mark_read(const Node& node) {
  TreeData::mark_read(node);
}

std::vector<std::filesystem::path> paths_read(const Node& root) {
  return TreeData::paths_read(root);
}

std::string canonical(const Node& root, const std::function<std::string(const std::filesystem::path&)>& in_place_of,
                      const std::set<std::string>& without) {
  return TreeData::canonical(root, in_place_of, without);
}

}  // namespace coast::config
