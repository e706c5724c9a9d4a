#include "coast/report/render.hpp"

#include <fmt/format.h>

#include "coast/io/input.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/record/error.hpp"
#include "commands.hpp"
#include "load.hpp"

namespace coast::cli {

void report(const std::filesystem::path& folder, const CommonOptions& options) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{512} << 20;  // pages of long recordings have some tens of MiB
  const std::filesystem::path stored = folder / "report.json";
  if (const auto awaited = io::awaited_result(folder))
    throw InputError({folder.string(), 0, "results of a run that was interrupted before it wrote " + *awaited,
                      "results of one run", "Files here may be of two runs: run it again."});
  const report::Page page = report::from_json(io::read_all(stored, kMostBytes), stored.string());
  const std::filesystem::path html =
      output_folder(stored, options.out.empty() ? folder : options.out, {"report.html"}) / "report.html";
  io::write_text(html, report::render(page));
  if (!options.quiet) fmt::print("report: {}\n", html.string());
}

}  // namespace coast::cli
