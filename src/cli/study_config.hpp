#pragma once
// study.yaml: what `coast outage` compares error models in, a recording or an ensemble of simulated ones.

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "coast/study/ensemble.hpp"
#include "run_config.hpp"

namespace coast::cli {

/// `run` and `sweep`: outages swept over one recording.
struct SweepStudy {
  RunConfig run;
  study::OutageSweep sweep;
  std::vector<study::NamedModel> models;
};

/// `scenario` and `seeds`: one scenario, simulated with many seeds.
struct EnsembleStudy {
  std::filesystem::path scenario;
  study::EnsemblePlan plan;                ///< one case for each truth, then one for each floor
  std::size_t truths = 0;                  ///< cases of the plan that are filtered with every error model
  std::vector<study::NamedModel> filters;  ///< those error models
};

using StudyConfig = std::variant<SweepStudy, EnsembleStudy>;

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] StudyConfig read_study(const std::filesystem::path& file);

}  // namespace coast::cli
