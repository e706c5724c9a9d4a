#pragma once

#include <string>
#include <string_view>

namespace coast::cli {

/// A text that ends with a line, without that end, every line behind `indent`: for examples on help pages.
[[nodiscard]] inline std::string indented(std::string_view text, const std::string& indent) {
  std::string all = indent;
  for (const char c : text.substr(0, text.size() - 1)) all += c == '\n' ? "\n" + indent : std::string(1, c);
  return all;
}

}  // namespace coast::cli
