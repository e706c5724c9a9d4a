#pragma once
// What the manual pages and the completions need of a parser's table; private to the manual.

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace coast::cli {

[[nodiscard]] inline std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// With a dash; or, in their order, those without.
[[nodiscard]] inline std::vector<const CLI::Option*> options(const CLI::App& app, bool positional) {
  return app.get_options([positional](const CLI::Option* option) { return option->get_positional() == positional; });
}

[[nodiscard]] inline bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

/// `--out`, or both `-h` and `--help`.
[[nodiscard]] std::vector<std::string> spellings(const CLI::Option& option);

/// What stands for its value: FILE, FOLDER, INT; without the limits that the parser adds.
[[nodiscard]] std::string value_name(const CLI::Option& option);

/// Values that are a choice: `a|b|c`; empty if it is none.
[[nodiscard]] std::vector<std::string> choices(const CLI::Option& option);

}  // namespace coast::cli
