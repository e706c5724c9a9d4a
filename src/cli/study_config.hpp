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
  struct Model {
    study::NamedModel named;
    std::optional<bool> noise_estimated;  ///< white noise of the IMU, by the recording itself; absent: as the run says
  };
  std::vector<Model> models;
};

/// `scenario` and `seeds`: one scenario, simulated with many seeds.
struct EnsembleStudy {
  std::filesystem::path scenario;
  study::EnsemblePlan plan;  ///< one case for each truth, then one for each floor
  std::size_t truths = 0;    ///< cases of the plan that are filtered with every error model
  std::size_t filters = 0;   ///< those error models
};

using StudyConfig = std::variant<SweepStudy, EnsembleStudy>;

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] StudyConfig read_study(const std::filesystem::path& file);

}  // namespace coast::cli
