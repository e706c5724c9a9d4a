#pragma once
// study.yaml of `coast calibrate`: what the estimators are tried on.

#include <filesystem>
#include <string>
#include <vector>

#include "coast/noise/estimator_study.hpp"

namespace coast::cli {

/// Other processes beside the truth, of which the Allan curve and the bounds are shown, nothing else.
struct StudyReading {
  std::string name;
  noise::StudyTruth truth;
};

struct EstimatorStudyConfig {
  std::filesystem::path file;
  std::string title;
  std::string signal_unit;  ///< of the signal; may be empty
  noise::EstimatorStudy study;
  std::vector<StudyReading> readings;

  /// A parameter's unit with that of the signal in it.
  [[nodiscard]] std::string unit(const std::string& of_parameter) const;
};

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] EstimatorStudyConfig read_estimator_study(const std::filesystem::path& file);

}  // namespace coast::cli
