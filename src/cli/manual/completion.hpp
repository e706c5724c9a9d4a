#pragma once
// Completions of the command line; private to the manual.

#include <CLI/CLI.hpp>
#include <string>

namespace coast::cli {

[[nodiscard]] std::string bash_completion(const CLI::App& app);
[[nodiscard]] std::string zsh_completion(const CLI::App& app);

}  // namespace coast::cli
