#pragma once
// Trajectory + sensors -> a recording with its truth.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/jobs/job.hpp"
#include "coast/simulate/scenario.hpp"

namespace coast::jobs {

/// scenario.yaml
struct SimulationConfig {
  std::filesystem::path file;
  simulate::Scenario scenario;
};
/// @param seed  instead of the scenario's
/// @throws InputError  anything missing, out of range or unknown, with file and line; a scenario without an error model
[[nodiscard]] SimulationConfig read_simulate(const std::filesystem::path& file, std::optional<std::uint64_t> seed = {});
[[nodiscard]] SimulationConfig read_simulate(const config::Node& root, std::optional<std::uint64_t> seed = {});

struct SimulationResult {
  simulate::SimulatedMission mission;
  std::optional<simulate::SimulatedObservations> observations;  ///< of rover and base, if the scenario has them
  std::vector<record::ImuRecording> array;                      ///< of each of the scenario's IMUs, by its own clock
  std::vector<record::AidRecording> aids;                       ///< of each aiding sensor, in the units of its file
};
/// The same numbers for any number of threads.
[[nodiscard]] SimulationResult simulate(const SimulationConfig& config, const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const SimulationConfig& config);
/// imu.csv, gnss.pos, truth.nav, error_model.yaml and the run.yaml that processes them; RINEX of rover and base with
/// run-rinex.yaml; the recordings of an array with array.yaml; one file for each aiding sensor.
void write(const SimulationConfig& config, const SimulationResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const SimulationConfig& config, const SimulationResult& result,
                               const std::filesystem::path& folder);

}  // namespace coast::jobs
