#include <fmt/format.h>

#include <mutex>

#include "coast/io/writers.hpp"
#include "coast/report/render.hpp"
#include "commands.hpp"
#include "estimator_study_result.hpp"
#include "load.hpp"
#include "progress.hpp"

namespace coast::cli {

void estimator_study(const std::filesystem::path& study_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const EstimatorStudyConfig config = read_estimator_study(study_yaml);
  const std::filesystem::path out =
      output_folder(study_yaml, options.out, {"estimator_study.json", "report.json", "report.html"});
  EstimatorStudyOutcome outcome;
  std::mutex mutex;
  outcome.result = noise::run_estimator_study(config.study, [&](double fraction) {
    const std::scoped_lock lock(mutex);
    line.show("simulating and estimating runs", fraction);
  });
  outcome.summaries = noise::summarise(config.study, outcome.result);
  line.clear();
  const report::Page page = estimator_study_page(config, outcome);
  io::write_text(out / "estimator_study.json", estimator_study_json(config, outcome));
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  if (!options.quiet) fmt::print("{}report: {}\n", estimator_study_text(config, outcome), (out / "report.html").string());
}

}  // namespace coast::cli
