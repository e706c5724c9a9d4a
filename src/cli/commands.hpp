#pragma once
// The subcommands; one file each.

#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace coast::cli {

/// Options that every subcommand has.
struct CommonOptions {
  std::filesystem::path out;  ///< empty: the input's name + ".out"
  bool quiet = false;
  int threads = 0;  ///< 0: all
};

/// `coast process run.yaml`: recordings -> forward filter -> smoother -> trajectory, summary.json, report.html.
void process(const std::filesystem::path& run_yaml, const CommonOptions& options);
/// `coast simulate scenario.yaml`: imu.csv, gnss.pos, truth.nav and a run.yaml that processes them.
void simulate(const std::filesystem::path& scenario_yaml, std::optional<std::uint64_t> seed, const CommonOptions& options);
/// `coast outage study.yaml`: outages x error models -> drift tables and figures.
void outage(const std::filesystem::path& study_yaml, const CommonOptions& options);
/// `coast calibrate INPUT`: static recordings -> error_model.yaml, calibration.json, report.html.
void calibrate(const std::filesystem::path& input, const CommonOptions& options);
/// `coast calibrate study.yaml` with schema coast.estimator_study/1: the estimators on simulated records ->
/// estimator_study.json, report.html.
void estimator_study(const std::filesystem::path& study_yaml, const CommonOptions& options);
/// Whether this file is such a study, by its schema key.
[[nodiscard]] bool is_estimator_study(const std::filesystem::path& file);
/// The study.yaml of the help page, every line behind `indent`.
[[nodiscard]] std::string estimator_study_example(const std::string& indent);
/// The calibration.yaml of the help page, every line behind `indent`.
[[nodiscard]] std::string calibration_example(const std::string& indent);
/// `coast ppk run.yaml`: RINEX of rover and base -> ppk.pos, ppk.json, residuals.csv, report.html.
void ppk(const std::filesystem::path& input, const CommonOptions& options);
/// The ppk.yaml of the help page, every line behind `indent`.
[[nodiscard]] std::string ppk_example(const std::string& indent);
/// `coast synth array.yaml`: several IMUs -> imu.csv, noise.csv, error_model.yaml, synth.json, report.html.
void synth(const std::filesystem::path& array_yaml, const CommonOptions& options);
/// `coast synth study.yaml` with schema coast.array_study/1: simulated arrays with known truth -> array_study.json,
/// report.html.
void array_study(const std::filesystem::path& study_yaml, const CommonOptions& options);
/// Whether this file is such a study, by its schema key.
[[nodiscard]] bool is_array_study(const std::filesystem::path& file);
/// The study.yaml of the help page, every line behind `indent`.
[[nodiscard]] std::string array_study_example(const std::string& indent);
/// The array.yaml of the help page, every line behind `indent`.
[[nodiscard]] std::string array_example(const std::string& indent);
struct DiagnoseOptions {
  int twins = 20;
  /// The user's own simulation in place of twins of the configured model: a scenario, or the run.yaml of a simulated recording.
  std::filesystem::path simulation;
};
/// `coast diagnose run.yaml`: what the configured model leaves out -> diagnosis.json, run.diagnosed.yaml, report.html.
void diagnose(const std::filesystem::path& run_yaml, const DiagnoseOptions& choice, const CommonOptions& options);
/// `coast compare a.nav b.nav`: differences a - b in N, E, D and attitude.
void compare(const std::filesystem::path& a, const std::filesystem::path& b, const Eigen::Vector3d& lever_arm_b,
             const CommonOptions& options);
/// `coast report DIR`: report.html again from report.json.
void report(const std::filesystem::path& folder, const CommonOptions& options);

}  // namespace coast::cli
