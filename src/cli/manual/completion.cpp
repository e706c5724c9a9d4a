#include "completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "option.hpp"

namespace coast::cli {

namespace {

std::vector<std::string> names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* one : subcommands(app)) names.push_back(one->get_name());
  return names;
}

std::vector<std::string> spellings_of(const CLI::App& app) {
  std::vector<std::string> all;
  for (const CLI::Option* one : options(app, false))
    for (std::string& name : spellings(*one)) all.push_back(std::move(name));
  return all;
}

/// Branches for the word behind an option: its choices, folders, or nothing for numbers. Files are what bash offers by itself.
std::string bash_values(const CLI::App& command) {
  std::string branches;
  for (const CLI::Option* one : options(command, false)) {
    if (!takes_value(*one) || value_name(*one) == "FILE") continue;
    std::string offered = "return";
    if (const std::vector<std::string> all = choices(*one); !all.empty())
      offered = fmt::format("mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$word\")\n      return", fmt::join(all, " "));
    if (value_name(*one) == "FOLDER") offered = "mapfile -t COMPREPLY < <(compgen -d -- \"$word\")\n      return";
    for (const std::string& name : spellings(*one))
      branches += fmt::format("    {},{})\n      {}\n      ;;\n", command.get_name(), name, offered);
  }
  return branches;
}

/// Between single quotes of zsh, in a place where colons and brackets mean something.
std::string quoted(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'')
      safe += "'\\'";
    else if (c == ':' || c == '[' || c == ']' || c == '\\')
      safe += '\\';
    safe += c;
  }
  return safe;
}

/// What _arguments offers as the value.
std::string zsh_value(const CLI::Option& option, const std::string& told) {
  if (const std::vector<std::string> all = choices(option); !all.empty())
    return fmt::format(":{}:({})", told, fmt::join(all, " "));
  const std::string type = value_name(option);
  return fmt::format(":{}:{}", told, type == "FOLDER" ? "_files -/" : type == "FILE" ? "_files" : "");
}

std::string zsh_option(const CLI::Option& option) {
  std::string lines;
  for (const std::string& name : spellings(option)) {
    std::string value;
    for (int i = 0; takes_value(option) && i < option.get_items_expected_max(); ++i)
      value += zsh_value(option, quoted(value_name(option)));
    lines += fmt::format("        '{}[{}]{}' \\\n", name, quoted(option.get_description()), value);
  }
  return lines;
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::string values, options_of;
  for (const CLI::App* one : subcommands(app)) {
    values += bash_values(*one);
    options_of += fmt::format("      {}) offered='{}' ;;\n", one->get_name(), fmt::join(spellings_of(*one), " "));
  }
  return fmt::format(R"(# Completion of coast in bash; made from the table behind coast --help.
_coast() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}} offered=
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W '{} {}' -- "$word")
    return
  fi
  case $command,$before in
{}  esac
  if [[ $word == -* ]]; then
    case $command in
{}    esac
    mapfile -t COMPREPLY < <(compgen -W "$offered" -- "$word")
  fi
}}
complete -o default -o filenames -F _coast coast
)",
                     fmt::join(names_of(app), " "), fmt::join(spellings_of(app), " "), values, options_of);
}

std::string zsh_completion(const CLI::App& app) {
  std::string described, branches;
  for (const CLI::App* one : subcommands(app)) {
    described += fmt::format("    '{}:{}'\n", one->get_name(), quoted(one->get_description()));
    branches += fmt::format("    {})\n      _arguments \\\n", one->get_name());
    for (const CLI::Option* option : options(*one, false)) branches += zsh_option(*option);
    for (const CLI::Option* option : options(*one, true))
      branches += fmt::format("        '{}' \\\n", zsh_value(*option, quoted(option->get_description())));
    branches += "        && return\n      ;;\n";
  }
  return fmt::format(R"(#compdef coast
# Completion of coast in zsh; made from the table behind coast --help.
_coast() {{
  local -a commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe subcommand commands
    return
  fi
  local command=$words[2]
  shift words
  ((CURRENT -= 1))
  case $command in
{}  esac
}}
_coast "$@"
)",
                     described, branches);
}

}  // namespace coast::cli
