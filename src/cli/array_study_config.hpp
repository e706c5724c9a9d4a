#pragma once
// study.yaml of arrays (schema coast.array_study/1): how good models, merges, defect tests and merged filters are on simulated
// sensors.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/array/defect_study.hpp"
#include "coast/array/merge_study.hpp"
#include "coast/config/node.hpp"
#include "coast/study/array_outages.hpp"

namespace coast::cli {

enum class ArrayStudyKind {
  kModels,   ///< coverage of ARMA-GARCH intervals
  kMerges,   ///< mean square errors of the ways of merging; models from residuals beside the truth
  kOutages,  ///< the same ways through the filter
  kDefects,  ///< detection rates, delays, false alarms
};

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

}  // namespace coast::cli
