#pragma once
// Effects missing in the configured model: where, what, how significant, and the gain from modelling them.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/diagnose/diagnosis.hpp"
#include "coast/jobs/run_file.hpp"

namespace coast::jobs {

struct DiagnosisConfig {
  RunConfig run;
  int twins = 20;      ///< simulated twins for comparison with the recording
  bool quick = false;  ///< one search: no twins, and no explanation that only another order or an exchange leads to
  /// The user's own simulation instead of twins of the configured model: a scenario, or the run.yaml of a simulated recording.
  std::filesystem::path simulation;
};
/// @throws InputError  anything missing, out of range or unknown, with file and line; a run that is tightly coupled, or already
///                     has effects
[[nodiscard]] DiagnosisConfig read_diagnose(const std::filesystem::path& run_yaml);
[[nodiscard]] DiagnosisConfig read_diagnose(const config::Node& root);

/// Result of the search in the user's own simulation.
struct SimulationCheck {
  std::string source;
  diagnose::Diagnosis diagnosis;
  std::string of_another_drive = {};  ///< why it is hardly comparable with the recording; empty if of the same drive
  /// Whether the effect is also found in the simulation, with about the same size.
  [[nodiscard]] bool has(const diagnose::Finding& finding) const;
};

struct DiagnosisResult {
  diagnose::Diagnosis diagnosis;
  bool quick = false;  ///< as configured
  std::optional<SimulationCheck> simulation;
  geo::GpsTime start, end;  ///< of the recording
};
/// @throws NumericalError  axes or units that contradict gravity or the course
[[nodiscard]] DiagnosisResult diagnose(const DiagnosisConfig& config, Recordings recordings, const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const DiagnosisConfig& config);
/// diagnosis.json (docs/schema/diagnosis.schema.json), run.diagnosed.yaml, error_model.diagnosed.yaml if it has changed,
/// report.html.
void write(const DiagnosisConfig& config, const DiagnosisResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const DiagnosisConfig& config, const DiagnosisResult& result,
                               const std::filesystem::path& folder);

}  // namespace coast::jobs
