#pragma once
// Spelling help for messages. It is in geo because geo (unit names) is the lowest library that needs it.

#include <string>
#include <string_view>
#include <vector>

namespace coast::geo {

/// Number of insertions, deletions, replacements and swaps of neighbours between two words (optimal string alignment;
/// Damerau 1964).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word of `known` nearest to `word`, the first of several; empty if none is within half the word's length (at least 1).
[[nodiscard]] std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

}  // namespace coast::geo
