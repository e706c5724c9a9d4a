// Output files and messages of `coast outage`.

#include <fmt/format.h>

#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/results.hpp"
#include "outage/study_journal.hpp"
#include "outage/tables.hpp"

namespace coast::jobs {

std::vector<std::string> files_of(const StudyConfig&) {
  return {"outage.json", "outages.csv", "report.json", "report.html"};
}

void write(const StudyConfig& config, const OutageStudy& study, const std::filesystem::path& folder) {
  report::Page page;
  page.title = "Outage study";
  page.subtitle = file_of(config).filename().string();
  page.footer = fmt::format("coast {}, coast outage", COAST_VERSION);
  add_durations(study, page);
  add_groups(study, page);
  io::begin_results(folder / "outage.json");
  io::write_text(folder / "outages.csv", outages_csv(study));
  write_page(page, folder);
  io::write_text(folder / "outage.json", outage_json(study).dump(1) + "\n");
  StudyJournalFile::remove(folder);
}

std::string told(const StudyConfig&, const OutageStudy&, const std::filesystem::path& folder) {
  return fmt::format("report: {}\n", (folder / "report.html").string());
}

}  // namespace coast::jobs
