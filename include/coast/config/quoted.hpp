#pragma once

#include <string>

namespace coast::config {

/// A YAML scalar in single quotes: the one style in which nothing but the quote itself needs care.
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace coast::config
