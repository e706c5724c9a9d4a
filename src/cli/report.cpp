#include "coast/report/render.hpp"

#include <fmt/format.h>

#include "coast/io/input.hpp"
#include "coast/io/writers.hpp"
#include "commands.hpp"

namespace coast::cli {

void report(const std::filesystem::path& folder, const CommonOptions& options) {
  const std::filesystem::path stored = folder / "report.json";
  const std::filesystem::path html = (options.out.empty() ? folder : options.out) / "report.html";
  io::write_text(html, coast::report::render(coast::report::from_json(io::read_all(stored), stored.string())));
  if (!options.quiet) fmt::print("report: {}\n", html.string());
}

}  // namespace coast::cli
