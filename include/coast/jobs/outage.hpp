#pragma once
// Outages x error models -> drift, for a recording or for an ensemble of simulated ones.

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/jobs/run_file.hpp"
#include "coast/study/ensemble.hpp"

namespace coast::jobs {

/// `run` and `sweep`: outages swept over one recording.
struct SweepStudy {
  std::filesystem::path file;
  RunConfig run;
  study::OutageSweep sweep;
  struct Model {
    study::NamedModel named;
    std::optional<bool> noise_estimated;  ///< white noise of the IMU, estimated from the recording; absent: as in the run
  };
  std::vector<Model> models;
};

/// `scenario` and `seeds`: one scenario, simulated with many seeds.
struct EnsembleStudy {
  std::filesystem::path file;
  std::filesystem::path scenario;
  study::EnsemblePlan plan;  ///< one case for each truth, then one for each floor
  std::size_t truths = 0;    ///< number of cases of the plan that are filtered with every error model
  std::size_t filters = 0;   ///< number of these error models
};

using StudyConfig = std::variant<SweepStudy, EnsembleStudy>;

/// study.yaml. @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] StudyConfig read_outage(const std::filesystem::path& file);
[[nodiscard]] StudyConfig read_outage(const config::Node& root);
/// The outages of a simulated study: swept over the scenario (a map), or a list, in seconds from its start.
/// @throws InputError  one is not within the scenario
[[nodiscard]] std::vector<study::OutageGroup> study_groups(const config::Node& set, double mission_s);
/// File of the study, for titles.
[[nodiscard]] const std::filesystem::path& file_of(const StudyConfig& config);

/// Result of a study. The runs of one truth are consecutive, one for each error model; floors come last.
struct OutageStudy {
  study::StudyResult result;
  std::size_t truths = 1;  ///< 1 for a recording
  std::size_t models = 1;
  std::string described;             ///< a sentence or two: data and reference
  bool simulated = false;            ///< otherwise one recording
  std::uint64_t first_seed = 0;      ///< of simulated ones
  std::vector<geo::Psd> gyro_noise;  ///< of simulated ones: the largest white density of each run's gyros
  [[nodiscard]] bool is_floor(std::size_t run) const { return run >= truths * models; }
};

/// @param resume  folder in which every outage is stored as soon as it is computed, and from which an interrupted study
///                continues; empty: nothing is stored
/// @throws InputError  no outage fits into the mission  @throws NumericalError
[[nodiscard]] OutageStudy outage(const StudyConfig& config, const Progress& progress, const std::filesystem::path& resume = {});
/// The same for recordings in memory.
[[nodiscard]] OutageStudy outage(const SweepStudy& config, const Recordings& recordings, const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const StudyConfig& config);
/// outages.csv, outage.json (docs/schema/outage.schema.json), report.html; the stored intermediate results are removed.
void write(const StudyConfig& config, const OutageStudy& study, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const StudyConfig& config, const OutageStudy& study, const std::filesystem::path& folder);

}  // namespace coast::jobs
