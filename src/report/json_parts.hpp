#pragma once
// Functions to write and read the JSON of a page. Private to the room.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "coast/report/page.hpp"

namespace coast::report {

using nlohmann::json;

// Names of the enumerators, in their order.
inline constexpr std::array<std::string_view, 4> kVerdicts{"none", "good", "warn", "bad"};
inline constexpr std::array<std::string_view, 19> kTones{
    "auto", "x",    "y",      "z",   "forward", "smoothed", "reference", "muted", "fixed", "float",
    "sbas", "dgps", "single", "ppp", "unknown", "good",     "warn",      "bad",   "faint"};
inline constexpr std::array<std::string_view, 3> kScales{"linear", "log", "time"};
inline constexpr std::array<std::string_view, 3> kStyles{"line", "dashed", "steps"};
inline constexpr std::array<std::string_view, 3> kNoteKinds{"info", "warning", "code"};

using Words = std::span<const std::string_view>;

template <typename Enum>
std::string word_of(Enum value, Words words) {
  return std::string(words[static_cast<std::size_t>(value)]);
}

template <typename Enum>
Enum enum_of(const json& node, const char* key, Words words) {
  const std::string word = node.value(key, std::string(words.front()));
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) throw std::invalid_argument(fmt::format("{}: unknown word '{}'", key, word));
  return static_cast<Enum>(found - words.begin());
}

/// Writes `value` under `key` unless it is the default of its type's member.
template <typename Value>
void put(json& node, const char* key, const Value& value, const Value& fallback = {}) {
  if (value != fallback) node[key] = value;
}

template <typename Enum>
void put_word(json& node, const char* key, Enum value, Words words) {
  if (value != Enum{}) node[key] = word_of(value, words);
}

inline std::string text(const json& node, const char* key) {
  return node.value(key, std::string{});
}

template <typename Item, typename Write>
void put_list(json& node, const char* key, const std::vector<Item>& items, Write write) {
  if (items.empty()) return;
  json& list = node[key] = json::array();
  for (const Item& item : items) list.push_back(write(item));
}

template <typename Item, typename Read>
std::vector<Item> read_list(const json& node, const char* key, Read read) {
  std::vector<Item> items;
  if (!node.contains(key)) return items;
  for (const json& item : node.at(key)) items.push_back(read(item));
  return items;
}

inline void require_length(std::size_t expected, std::size_t found, const std::string& what) {
  if (expected != found) throw std::invalid_argument(fmt::format("{}: {} values, expected {}", what, found, expected));
}

// --- json_plot.cpp

[[nodiscard]] json write_panel(const Panel& panel);
[[nodiscard]] Panel read_panel(const json& node);

}  // namespace coast::report
