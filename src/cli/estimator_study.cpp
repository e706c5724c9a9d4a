#include <fmt/format.h>

#include "coast/io/results_folder.hpp"
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
  const auto runs = [&line](double fraction) { line.show("simulating and estimating runs", fraction); };
  runs(0.0);  // the first may take minutes
  outcome.result = noise::run_estimator_study(config.study, runs);
  outcome.summaries = noise::summarise(config.study, outcome.result);
  line.show("writing", 0.0);
  const report::Page page = estimator_study_page(config, outcome);
  io::begin_results(out / "estimator_study.json");
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  io::write_text(out / "estimator_study.json", estimator_study_json(config, outcome));
  line.clear();
  if (!options.quiet) fmt::print("{}report: {}\n", estimator_study_text(config, outcome), (out / "report.html").string());
}

}  // namespace coast::cli
