#include "common/results.hpp"

#include "coast/io/writers.hpp"
#include "coast/report/render.hpp"

namespace coast::jobs {

void write_page(const report::Page& page, const std::filesystem::path& folder) {
  io::write_text(folder / "report.json", report::to_json(page));
  io::write_text(folder / "report.html", report::render(page));
}

}  // namespace coast::jobs
