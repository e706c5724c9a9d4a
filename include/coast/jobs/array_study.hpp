#pragma once
// Accuracy of models, merges, defect tests and merged filters on simulated arrays with known truth.

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coast/array/defect_study.hpp"
#include "coast/array/merge_study.hpp"
#include "coast/config/node.hpp"
#include "coast/jobs/job.hpp"
#include "coast/noise/arma_garch_study.hpp"
#include "coast/study/array_outages.hpp"

namespace coast::jobs {

enum class ArrayStudyKind {
  kModels,   ///< coverage of ARMA-GARCH intervals
  kMerges,   ///< mean square errors of the merging methods; models from residuals compared with the truth
  kOutages,  ///< the same methods in the filter
  kDefects,  ///< detection rates, delays, false alarms
};

/// study.yaml, schema coast.array_study/1.
struct ArrayStudyConfig {
  config::Node root;
  std::filesystem::path file;
  ArrayStudyKind kind = ArrayStudyKind::kMerges;
  std::size_t runs = 100;
  std::uint64_t first_seed = 1;
  std::size_t samples = 20000;
  noise::ArmaGarch model;  ///< of kModels
  // of kMerges: every number of sensors with every motion
  array::MergeStudyOptions merges;
  std::vector<double> motions;
  std::vector<std::size_t> counts;
  std::optional<study::ArrayOutagePlan> outages;
  array::DefectStudyOptions defects;
  std::size_t injections = 500;
};

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] ArrayStudyConfig read_array_study(const std::filesystem::path& file);
[[nodiscard]] ArrayStudyConfig read_array_study(const config::Node& root);

/// The study.yaml of the help page, every line preceded by `indent`.
[[nodiscard]] std::string array_study_example(const std::string& indent);

/// The merging methods for one number of sensors and one motion.
struct MergeCase {
  std::size_t sensors = 0;
  double motion_rms = 0.0;
  array::MergeStudy study;
};
/// By the kind of the study: coverage of intervals, merging methods, the same in the filter, defects.
using ArrayStudyResult =
    std::variant<noise::ArmaGarchStudy, std::vector<MergeCase>, std::vector<study::ArrayOutageRun>, array::DefectStudyResult>;

/// @throws InputError  a study that cannot be run
[[nodiscard]] ArrayStudyResult array_study(const ArrayStudyConfig& config, const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const ArrayStudyConfig& config);
/// array_study.json (docs/schema/array_study_result.schema.json), report.html.
void write(const ArrayStudyConfig& config, const ArrayStudyResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const ArrayStudyConfig& config, const ArrayStudyResult& result,
                               const std::filesystem::path& folder);

}  // namespace coast::jobs
