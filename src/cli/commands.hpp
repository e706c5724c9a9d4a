#pragma once
// The subcommands: each reads its configuration, runs its job, writes the results, and prints a summary.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "coast/jobs/convert.hpp"

namespace coast::cli {

/// Options common to all subcommands.
struct CommonOptions {
  std::filesystem::path out;  ///< empty: the input's name + ".out"
  bool quiet = false;
  int threads = 0;  ///< 0: all
};

void process(const std::filesystem::path& run_yaml, const CommonOptions& options);
void simulate(const std::filesystem::path& scenario_yaml, std::optional<std::uint64_t> seed, const CommonOptions& options);
void outage(const std::filesystem::path& study_yaml, const CommonOptions& options);
/// A calibration, or a study of estimators if the file has that schema.
void calibrate(const std::filesystem::path& input, const CommonOptions& options);
void ppk(const std::filesystem::path& input, const CommonOptions& options);
/// An array, or a study of arrays if the file has that schema.
void synth(const std::filesystem::path& input, const CommonOptions& options);
/// A table of estimates, or fleet.yaml.
void fleet(const std::filesystem::path& input, const CommonOptions& options);
struct DiagnoseOptions {
  int twins = 20;
  bool quick = false;
  std::filesystem::path simulation;
};
void diagnose(const std::filesystem::path& run_yaml, const DiagnoseOptions& choice, const CommonOptions& options);
void compare(const std::filesystem::path& first, const std::filesystem::path& second, const Eigen::Vector3d& lever_arm_b,
             const CommonOptions& options);
struct ConvertOptions {
  std::string format;  ///< empty: by the extension
  std::optional<int> gps_week;
  std::optional<double> rate_hz;
  std::optional<double> geoid_height_m;
  io::ProjectionOptions projection;  ///< none if its CRS is empty
  std::string heights;               ///< empty: as the CRS has it
};
void convert(const std::filesystem::path& input, const std::filesystem::path& output, const ConvertOptions& choice,
             const CommonOptions& options);
/// Prints what is in a file.
void inspect(const std::filesystem::path& file, std::optional<int> gps_week, const CommonOptions& options);
struct CampaignOptions {
  std::string what;    ///< plan, run, status, collect or submit
  std::string shard;   ///< empty: all units
  bool again = false;  ///< those that have failed, too
  std::string engine;  ///< slurm, parallel or snakemake
  bool now = false;    ///< start what was written for the engine
};
void campaign(const std::filesystem::path& plan_yaml, const CampaignOptions& choice, const CommonOptions& options);
void report(const std::filesystem::path& folder, const CommonOptions& options);

}  // namespace coast::cli
