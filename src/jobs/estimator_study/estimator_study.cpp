#include "coast/jobs/estimator_study.hpp"

#include <fmt/format.h>

#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/results.hpp"
#include "estimator_study/result.hpp"

namespace coast::jobs {

EstimatorStudyOutcome estimator_study(const EstimatorStudyConfig& config, const Progress& progress) {
  EstimatorStudyOutcome outcome;
  const auto runs = [&progress](double fraction) { progress("simulating and estimating runs", fraction); };
  runs(0.0);  // the first may take minutes
  outcome.result = noise::run_estimator_study(config.study, runs);
  outcome.summaries = noise::summarise(config.study, outcome.result);
  return outcome;
}

std::vector<std::string> files_of(const EstimatorStudyConfig&) {
  return {"estimator_study.json", "report.json", "report.html"};
}

void write(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome, const std::filesystem::path& folder) {
  const report::Page page = estimator_study_page(config, outcome);
  io::begin_results(folder / "estimator_study.json");
  write_page(page, folder);
  io::write_text(folder / "estimator_study.json", estimator_study_json(config, outcome));
}

std::string told(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome,
                 const std::filesystem::path& folder) {
  return fmt::format("{}report: {}\n", estimator_study_text(config, outcome), (folder / "report.html").string());
}

}  // namespace coast::jobs
