#pragma once
// Manual pages in man(7); private to the manual.

#include <CLI/CLI.hpp>
#include <string>

namespace coast::cli {

/// @param app  of which it is the page: the program, or a subcommand  @param version  of the program
[[nodiscard]] std::string manual_page(const CLI::App& app, const std::string& version);

/// coast, coast-process, ..
[[nodiscard]] std::string manual_name(const CLI::App& app);

}  // namespace coast::cli
