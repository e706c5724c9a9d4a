#pragma once
// Page -> one HTML file, and Page <-> JSON, so that the HTML can be generated again from stored results.

#include <string>
#include <string_view>

#include "coast/report/page.hpp"

namespace coast::report {

/// One HTML document with style, program and data inlined: opens from disk without a network.
/// Curves are stored as 32 bit floats, sorted x as counts of a power of ten finer than 3e-9 of its
/// span, both compressed.
/// @throws std::invalid_argument an id occurs twice or is empty, or arrays of one curve differ in length; the message names it
[[nodiscard]] std::string render(const Page& page);

/// The page as JSON (docs/schema/page.schema.json), with the same compressed arrays.  @throws as render
[[nodiscard]] std::string to_json(const Page& page);

/// @param source  file name for messages
/// @throws InputError  not JSON, not this schema, or an array that does not decode
[[nodiscard]] Page from_json(std::string_view text, const std::string& source);

}  // namespace coast::report
