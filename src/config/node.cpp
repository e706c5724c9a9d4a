#include "coast/config/node.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "coast/geo/nearest_word.hpp"
#include "tree.hpp"

namespace coast::config {

namespace {

std::string describe(const TreeEntry& e) {
  switch (e.kind) {
    case Kind::kMap:
      return "a map of keys";
    case Kind::kList:
      return fmt::format("a list of {}", e.children.size());
    case Kind::kNull:
      return "no value";
    case Kind::kScalar:
      break;
  }
  return fmt::format("'{}'", e.text);
}

// YAML allows a leading '+', from_chars does not.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

template <typename Number>
bool parse(std::string_view text, Number& value) {
  text = without_plus(text);
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  return status == std::errc() && end == text.data() + text.size();
}

std::string listed(const std::vector<std::string_view>& names) {
  std::string list;
  for (std::string_view name : names) list += (list.empty() ? "" : " | ") + std::string(name);
  return list;
}

std::size_t match(const Node& node, std::string_view word, const std::vector<std::string_view>& names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == word) return i;
  }
  const std::string near = nearest(word, {names.begin(), names.end()});
  throw node.error(fmt::format("'{}'", word), "one of " + listed(names),
                   near.empty() ? "" : fmt::format("The nearest is '{}'.", near));
}

}  // namespace

Node make_root(std::shared_ptr<TreeData> data) {
  data->entries.front().asked = true;
  Node node;
  node.data_ = std::move(data);
  node.index_ = 0;
  return node;
}

Node::Node() : data_(std::make_shared<TreeData>()) {
  data_->entries.emplace_back();
  data_->entries.front().asked = true;
}

bool Node::is_map() const {
  return data_->entries[index_].kind == Kind::kMap;
}
bool Node::is_list() const {
  return data_->entries[index_].kind == Kind::kList;
}
bool Node::is_scalar() const {
  return data_->entries[index_].kind == Kind::kScalar;
}

std::optional<Node> Node::find(std::string_view key) const {
  TreeEntry& e = data_->entries[index_];
  if (e.kind != Kind::kMap) throw error(describe(e), fmt::format("a map with the key '{}'", key));
  e.asked_keys.emplace(key);
  const TreeEntry* child = data_->child(index_, key);
  if (child == nullptr) return std::nullopt;
  Node node = *this;
  node.index_ = data_->index_of(*child);
  data_->entries[node.index_].asked = true;
  return node;
}

Node Node::at(std::string_view key) const {
  if (auto child = find(key)) return *child;
  std::vector<std::string> unasked;
  for (std::size_t i : data_->entries[index_].children) {
    if (!data_->entries[i].asked) unasked.push_back(data_->entries[i].key);
  }
  const std::string near = nearest(key, unasked);
  throw error(fmt::format("the key '{}' is missing", key), "",
              near.empty() ? "Add it." : fmt::format("Is '{}' meant to be it?", near));
}

Node Node::section(std::string_view key) const {
  if (auto child = find(key)) {
    if (!child->is_map()) throw child->error(describe(data_->entries[child->index_]), "a map of keys");
    return *child;
  }
  TreeEntry empty;
  empty.key = key;
  empty.asked = true;
  Node node = *this;
  node.index_ = data_->add(index_, std::move(empty));
  return node;
}

std::vector<Node> Node::items() const {
  const TreeEntry& e = data_->entries[index_];
  if (e.kind != Kind::kList) throw error(describe(e), "a list", e.kind == Kind::kNull ? "An empty list is written []." : "");
  std::vector<Node> nodes(e.children.size(), *this);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].index_ = e.children[i];
    data_->entries[e.children[i]].asked = true;
  }
  return nodes;
}

std::vector<std::string> Node::keys() const {
  const TreeEntry& e = data_->entries[index_];
  if (e.kind != Kind::kMap) throw error(describe(e), "a map of keys");
  std::vector<std::string> names;
  for (std::size_t i : e.children) names.push_back(data_->entries[i].key);
  return names;
}

std::string Node::text() const {
  const TreeEntry& e = data_->entries[index_];
  if (e.kind != Kind::kScalar) throw error(describe(e), "a single value");
  return e.text;
}

double Node::number() const {
  const TreeEntry& e = data_->entries[index_];
  double value = 0.0;
  if (e.kind != Kind::kScalar || !parse(e.text, value) || !std::isfinite(value)) throw error(describe(e), "a finite number");
  return value;
}

long Node::integer() const {
  const TreeEntry& e = data_->entries[index_];
  long value = 0;
  if (e.kind != Kind::kScalar || !parse(e.text, value)) throw error(describe(e), "a whole number");
  return value;
}

bool Node::flag() const {
  const TreeEntry& e = data_->entries[index_];
  if (e.kind != Kind::kScalar || (e.text != "true" && e.text != "false")) throw error(describe(e), "true or false");
  return e.text == "true";
}

std::vector<double> Node::numbers() const {
  if (!is_list()) throw error(describe(data_->entries[index_]), "a list of numbers");
  std::vector<double> values;
  for (const Node& item : items()) values.push_back(item.number());
  return values;
}

Eigen::Vector3d Node::vector3() const {
  if (!is_list() || items().size() != 3) throw error(describe(data_->entries[index_]), "a list of three numbers");
  const std::vector<double> v = numbers();
  return {v[0], v[1], v[2]};
}

std::filesystem::path Node::path() const {
  TreeEntry& e = data_->entries[index_];
  if (e.kind != Kind::kScalar) throw error(describe(e), "a path");
  if (e.table) return e.text;
  e.is_path = true;
  return resolve_path(*data_, index_);
}

const std::filesystem::path& Node::file() const {
  return data_->file;
}

std::shared_ptr<const record::Table> Node::table() const {
  return data_->entries[index_].table;
}

double Node::number(std::string_view key, double fallback) const {
  if (const auto child = find(key)) return child->number();
  data_->entries[index_].defaults[std::string(key)] = yaml_text(fallback);
  return fallback;
}

long Node::integer(std::string_view key, long fallback) const {
  if (const auto child = find(key)) return child->integer();
  data_->entries[index_].defaults[std::string(key)] = std::to_string(fallback);
  return fallback;
}

bool Node::flag(std::string_view key, bool fallback) const {
  if (const auto child = find(key)) return child->flag();
  data_->entries[index_].defaults[std::string(key)] = fallback ? "true" : "false";
  return fallback;
}

std::string Node::text(std::string_view key, std::string_view fallback) const {
  if (const auto child = find(key)) return child->text();
  data_->entries[index_].defaults[std::string(key)] = yaml_text(fallback);
  return std::string(fallback);
}

Eigen::Vector3d Node::vector3(std::string_view key, const Eigen::Vector3d& fallback) const {
  if (const auto child = find(key)) return child->vector3();
  data_->entries[index_].defaults[std::string(key)] = yaml_text(fallback);
  return fallback;
}

std::size_t Node::choice(const std::vector<std::string_view>& names) const {
  return match(*this, text(), names);
}

std::size_t Node::choice(std::string_view key, const std::vector<std::string_view>& names, std::size_t fallback) const {
  if (const auto child = find(key)) return child->choice(names);
  data_->entries[index_].defaults[std::string(key)] = yaml_text(names.at(fallback));
  return fallback;
}

double Node::number_within(std::string_view key, double fallback, double low, double high) const {
  const double value = number(key, fallback);
  if (value < low || value > high) {
    const Node node = find(key).value_or(*this);
    throw node.error(fmt::format("{}", value), fmt::format("a number from {} to {}", low, high));
  }
  return value;
}

InputError Node::error(std::string_view found, std::string_view expected, std::string_view what_to_do) const {
  return data_->error(index_, found, expected, what_to_do);
}

std::string Node::where() const {
  const std::string source = data_->source_of(index_);
  const std::string key = data_->path_of(index_);
  if (source.empty() || key.empty()) return source + key;
  return source + ": " + key;
}

void Node::note_estimated(std::string_view key, std::string_view value) const {
  data_->entries[index_].estimated[std::string(key)] = std::string(value);
}

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  return geo::nearest_word(word, known);
}

}  // namespace coast::config
