#pragma once
// Small text functions shared by several readers.

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace coast::io {

[[nodiscard]] inline bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

[[nodiscard]] inline std::string_view trimmed(std::string_view s) {
  while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && (is_blank(s.back()) || s.back() == '\r')) s.remove_suffix(1);
  return s;
}

[[nodiscard]] inline std::string_view unquoted(std::string_view s) {
  s = trimmed(s);
  if (s.size() >= 2 && s.front() == '"' && s.back() == '"') s = trimmed(s.substr(1, s.size() - 2));
  return s;
}

/// A number that fills the whole text (surrounding blanks allowed); `nan` and `inf` are numbers here.
[[nodiscard]] std::optional<double> parse_number(std::string_view s);

/// Splits at the delimiter, or at runs of white space if it is ' '. Quoted fields keep their delimiters.
void split(std::string_view line, char delimiter, std::vector<std::string_view>& fields);

/// Shortened for messages, control characters shown as '?'.
[[nodiscard]] std::string excerpt(std::string_view s, std::size_t length = 40);

/// A field of a CSV file; quoted where it needs it.
[[nodiscard]] std::string csv_field(const std::string& text);

}  // namespace coast::io
