#pragma once
// Generates the HTML page again from stored results.

#include <filesystem>

#include "coast/jobs/job.hpp"

namespace coast::jobs {

/// Generates report.html from the report.json in `folder`. @param out  output; empty: the same folder  @return the page
/// @throws InputError  no page is stored there, or the results are from an interrupted run
std::filesystem::path render_again(const std::filesystem::path& folder, const std::filesystem::path& out);

}  // namespace coast::jobs
