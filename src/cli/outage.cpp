#include <fmt/format.h>

#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/report/render.hpp"
#include "commands.hpp"
#include "load.hpp"
#include "outage_study.hpp"
#include "progress.hpp"

namespace coast::cli {

void outage(const std::filesystem::path& study_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const study::Progress progress = line.stages();
  const StudyConfig config = read_study(study_yaml);
  const std::filesystem::path out =
      output_folder(study_yaml, options.out, {"outage.json", "outages.csv", "report.json", "report.html"});

  std::optional<StudyJournalFile> file;
  const OpenJournal journal = [&](std::uint64_t made_from) {
    file.emplace(out, made_from);
    if (file->known() > 0 && !options.quiet) {
      line.clear();
      fmt::print("going on from {} outages of an interrupted run\n", file->known());
    }
    return file->callbacks();
  };
  const auto* sweep = std::get_if<SweepStudy>(&config);
  const OutageStudy study =
      sweep != nullptr ? run_sweep(*sweep, journal, progress) : run_seeds(std::get<EnsembleStudy>(config), journal, progress);
  line.show("writing", 0.0);

  report::Page page;
  page.title = "Outage study";
  page.subtitle = study_yaml.filename().string();
  page.footer = fmt::format("coast {}, coast outage", COAST_VERSION);
  add_durations(study, page);
  add_groups(study, page);
  io::begin_results(out / "outage.json");
  io::write_text(out / "outages.csv", outages_csv(study));
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  io::write_text(out / "outage.json", outage_json(study).dump(1) + "\n");
  file->remove();
  line.clear();
  if (!options.quiet) fmt::print("report: {}\n", (out / "report.html").string());
}

}  // namespace coast::cli
