#pragma once

#include <string>

namespace coast::config {

/// A YAML scalar in single quotes, the style in which only the quote itself is escaped.
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace coast::config
