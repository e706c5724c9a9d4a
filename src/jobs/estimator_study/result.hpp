#pragma once
// A study of estimators as text and page.

#include <string>
#include <vector>

#include "coast/jobs/estimator_study.hpp"
#include "coast/report/page.hpp"

namespace coast::jobs {

/// estimator_study.json (docs/schema/estimator_study_result.schema.json).
[[nodiscard]] std::string estimator_study_json(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome);
/// A few lines per estimator for the terminal.
[[nodiscard]] std::string estimator_study_text(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome);
[[nodiscard]] report::Page estimator_study_page(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome);

/// Number of runs in which BIC selected each of the choices.
[[nodiscard]] std::vector<std::size_t> times_chosen(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome);

/// Averaging times for the curve of a model: from the interval to a third of the record.
[[nodiscard]] std::vector<double> averaging_times(const noise::EstimatorStudy& study, int per_decade);
/// Allan deviation of the truth's processes and slope.
[[nodiscard]] double allan_deviation(const noise::StudyTruth& truth, double interval, double tau);

}  // namespace coast::jobs
