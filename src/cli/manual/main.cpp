// manual OUT: writes the manual pages and the completions of the program, from its table of options, into a folder.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "command_line.hpp"
#include "completion.hpp"
#include "option.hpp"
#include "page.hpp"

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream out(file);
  if (!(out << text).flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

void write_all(const std::filesystem::path& folder) {
  coast::cli::CommandLine line;
  const CLI::App& app = line.app();
  const auto write_page = [&](const CLI::App& page) {
    write(folder / "man" / (coast::cli::manual_name(page) + ".1"), coast::cli::manual_page(page, COAST_VERSION));
  };
  write_page(app);
  for (const CLI::App* one : coast::cli::subcommands(app)) write_page(*one);
  write(folder / "completions" / "coast", coast::cli::bash_completion(app));
  write(folder / "completions" / "_coast", coast::cli::zsh_completion(app));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw std::runtime_error("usage: manual OUT");
    write_all(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "manual: {}\n", error.what());
    return 1;
  }
  return 0;
}
