#pragma once
// A study of arrays as text and page.

#include <string>

#include "coast/jobs/array_study.hpp"
#include "coast/report/page.hpp"
#include "coast/study/paired.hpp"

namespace coast::jobs {

/// array_study.json
[[nodiscard]] std::string array_study_json(const ArrayStudyConfig& config, const ArrayStudyResult& result);
[[nodiscard]] report::Page array_study_page(const ArrayStudyConfig& config, const ArrayStudyResult& result);

/// Ratio of the mean square errors of each way of merging to the plain mean's, with 95 % interval from the scatter of runs.
[[nodiscard]] study::PairedRatio ratio_to_mean(const MergeCase& one, const array::MergeResult& merge);
/// Ratio of a filter's largest horizontal errors to those with the plain mean, pair by pair.
[[nodiscard]] study::PairedRatio ratio_to_mean(const std::vector<study::ArrayOutageRun>& runs, const study::ArrayOutageRun& run,
                                               bool smoothed);
[[nodiscard]] double share(std::size_t part, std::size_t whole);

}  // namespace coast::jobs
