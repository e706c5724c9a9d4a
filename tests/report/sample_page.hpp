#pragma once

#include "coast/report/page.hpp"

namespace coast::test {

/// A page with every kind of tile, note, table and panel, from one hour of made-up motion at 200 Hz, decimated as in a run.
/// Nothing on it is computed by a filter; it has the sizes and shapes of what a run shows.
[[nodiscard]] report::Page sample_page();

}  // namespace coast::test
