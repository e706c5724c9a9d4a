#include "text.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>

namespace coast::io {

std::optional<double> parse_number(std::string_view s) {
  s = trimmed(s);
  if (s.size() > 1 && s.front() == '+' && s[1] != '-') s.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = fast_float::from_chars(s.data(), s.data() + s.size(), value);
  if (error != std::errc() || end != s.data() + s.size()) return std::nullopt;
  return value;
}

void split(std::string_view line, char delimiter, std::vector<std::string_view>& fields) {
  fields.clear();
  const bool blanks = delimiter == ' ';
  std::size_t i = 0;
  while (true) {
    if (blanks) {
      while (i < line.size() && is_blank(line[i])) ++i;
      if (i == line.size()) return;
    }
    const std::size_t begin = i;
    bool quoted = false;
    for (; i < line.size(); ++i) {
      if (line[i] == '"') quoted = !quoted;
      if (!quoted && (blanks ? is_blank(line[i]) : line[i] == delimiter)) break;
    }
    fields.push_back(line.substr(begin, i - begin));
    if (i == line.size()) return;
    ++i;
  }
}

std::string excerpt(std::string_view s, std::size_t length) {
  std::string text(s.substr(0, length));
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126; }, '?');
  if (s.size() > length) text += "...";
  return text;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",;\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace coast::io
