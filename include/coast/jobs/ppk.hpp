#pragma once
// RINEX of rover and base -> fixed carrier-phase positions.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coast/carrier/base_position.hpp"
#include "coast/carrier/ppk.hpp"
#include "coast/config/node.hpp"
#include "coast/io/projection.hpp"
#include "coast/jobs/job.hpp"
#include "coast/record/antenna.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/navigation.hpp"
#include "coast/record/observation.hpp"
#include "coast/record/precise_orbits.hpp"

namespace coast::jobs {

/// The map `ppk` of run.yaml, or a separate file.
struct PpkConfig {
  config::Node map;
  std::filesystem::path rover, base;
  std::vector<std::filesystem::path> navigation;
  std::vector<std::filesystem::path> sp3, clocks;  ///< precise orbits; clocks at shorter intervals than theirs
  std::optional<std::filesystem::path> antex;      ///< phase centres of both antennas
  carrier::BaseAt base_at;
  bool broadcast_ionosphere = true;  ///< for single-point positions
  carrier::PpkOptions options;
  std::shared_ptr<io::Projection> projection;  ///< of ppk.grid.csv; null: none

  [[nodiscard]] static PpkConfig from(const config::Node& map);
};

/// A run.yaml, of which `gnss: {ppk: ..}` is used, or a file with these keys only.
/// @throws InputError  with file and line
[[nodiscard]] PpkConfig read_ppk(const std::filesystem::path& file);
[[nodiscard]] PpkConfig read_ppk(const config::Node& root);

/// The ppk.yaml of the help page, every line preceded by `indent`.
[[nodiscard]] std::string ppk_example(const std::string& indent);

/// Content of all input files.
struct PpkRecordings {
  record::ObservationRecording rover, base;
  record::NavigationRecording navigation;
  std::optional<record::PreciseOrbits> precise;  ///< instead of the broadcast orbits
  record::PreciseClocks clocks;                  ///< at shorter intervals than those of the precise orbits
  std::optional<record::AntennaTable> antennas;  ///< phase centres of both antennas and of satellites
};
/// @throws InputError
[[nodiscard]] PpkRecordings load(const PpkConfig& config);

struct PpkResult {
  carrier::PpkSolution solution;
  carrier::PpkOptions options;                         ///< options used in the solution
  record::GnssRecording fixes;                         ///< the solution as GNSS input of the filter
  Eigen::Vector3d r_base_e = Eigen::Vector3d::Zero();  ///< base antenna, ECEF, m; if it moves, at the first epoch
  std::string base_from;                               ///< source of this position, in words
  std::string rover, base;                             ///< receiver and antenna, in words
  record::Events events;                               ///< of all files and of the solution
};

/// @throws InputError  a file that is missing or of the wrong kind, orbits for another day  @throws NumericalError
[[nodiscard]] PpkResult ppk(const PpkConfig& config, const Progress& progress);
/// The same for recordings in memory; the paths of the configuration are not used.
[[nodiscard]] PpkResult ppk(const PpkConfig& config, PpkRecordings recordings, const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const PpkConfig& config);
/// ppk.pos, with a projection ppk.grid.csv, ppk.json (docs/schema/ppk_result.schema.json), residuals.csv, ppk.resolved.yaml,
/// report.html; of a moving base baselines.csv, as the aid `baseline` of a run file reads it.
void write(const PpkConfig& config, const PpkResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const PpkConfig& config, const PpkResult& result, const std::filesystem::path& folder);
/// Summary of the result, sentence by sentence.
[[nodiscard]] std::vector<std::string> ppk_sentences(const PpkResult& result);
/// @throws NumericalError  no epoch has a position
void require_positions(const PpkConfig& config, const PpkResult& result, const std::filesystem::path& folder);

}  // namespace coast::jobs
