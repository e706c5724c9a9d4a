#include "coast/jobs/report.hpp"

#include <cstdint>

#include "coast/io/input.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/report/render.hpp"

namespace coast::jobs {

std::filesystem::path render_again(const std::filesystem::path& folder, const std::filesystem::path& out) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{512} << 20;  // pages of long recordings have some tens of MiB
  const std::filesystem::path stored = folder / "report.json";
  if (const auto awaited = io::awaited_result(folder))
    throw InputError({folder.string(), 0, "results of a run that was interrupted before it wrote " + *awaited,
                      "results of one run", "The folder may mix files of two runs: run the job again."});
  const report::Page page = report::from_json(io::read_all(stored, kMostBytes), stored.string());
  std::filesystem::path html = results_folder(stored, out.empty() ? folder : out, {"report.html"}) / "report.html";
  io::write_text(html, report::render(page));
  return html;
}

}  // namespace coast::jobs
