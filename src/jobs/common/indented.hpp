#pragma once

#include <string>
#include <string_view>

namespace coast::jobs {

/// A text that ends with a newline, without this newline, with `indent` before every line: for examples on help pages.
[[nodiscard]] inline std::string indented(std::string_view text, const std::string& indent) {
  std::string all = indent;
  for (const char c : text.substr(0, text.size() - 1)) all += c == '\n' ? "\n" + indent : std::string(1, c);
  return all;
}

}  // namespace coast::jobs
