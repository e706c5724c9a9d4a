#pragma once
// Output of every job in addition to its numbers.

#include <filesystem>

#include "coast/report/page.hpp"

namespace coast::jobs {

/// report.json and the page generated from it, report.html.
void write_page(const report::Page& page, const std::filesystem::path& folder);

}  // namespace coast::jobs
