#pragma once
// The estimators of static records, on simulated records of known processes.

#include <filesystem>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/jobs/job.hpp"
#include "coast/noise/estimator_study.hpp"

namespace coast::jobs {

/// Other processes in addition to the truth; only their Allan curve and bounds are shown.
struct StudyReading {
  std::string name;
  noise::StudyTruth truth;
};

/// study.yaml of `coast calibrate`.
struct EstimatorStudyConfig {
  std::filesystem::path file;
  std::string title;
  std::string signal_unit;  ///< of the signal; may be empty
  noise::EstimatorStudy study;
  std::vector<StudyReading> readings;

  /// A parameter's unit with the signal's unit inserted.
  [[nodiscard]] std::string unit(const std::string& of_parameter) const;
};

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] EstimatorStudyConfig read_estimator_study(const std::filesystem::path& file);
[[nodiscard]] EstimatorStudyConfig read_estimator_study(const config::Node& root);

/// The study.yaml of the help page, every line preceded by `indent`.
[[nodiscard]] std::string estimator_study_example(const std::string& indent);

struct EstimatorStudyOutcome {
  noise::EstimatorStudyResult result;
  std::vector<noise::EstimatorSummary> summaries;  ///< one per estimator
};

[[nodiscard]] EstimatorStudyOutcome estimator_study(const EstimatorStudyConfig& config, const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const EstimatorStudyConfig& config);
/// estimator_study.json (docs/schema/estimator_study_result.schema.json), report.html.
void write(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome,
                               const std::filesystem::path& folder);

}  // namespace coast::jobs
