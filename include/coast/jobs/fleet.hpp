#pragma once
// Statistics of a fleet: the estimates of many missions of the same sensors -> values, what changed and when, which missions
// depart.

#include <filesystem>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/fleet/changes.hpp"
#include "coast/fleet/pool.hpp"
#include "coast/geo/time.hpp"
#include "coast/jobs/job.hpp"
#include "coast/record/event.hpp"

namespace coast::jobs {

/// fleet.yaml, or a table of estimates alone.
struct FleetConfig {
  std::filesystem::path file;
  std::vector<std::filesystem::path> estimates;  ///< tables: mission, unit, start, quantity, axis, value, sigma, ..
  std::vector<std::string> groups;  ///< further columns that group missions; empty: firmware, where there is such a column
  fleet::ChangeOptions options;
};

/// @param file  fleet.yaml, or anything else: a table of estimates
/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] FleetConfig read_fleet(const std::filesystem::path& file);
[[nodiscard]] FleetConfig read_fleet(const config::Node& root);
/// The fleet.yaml of the help page, every line preceded by `indent`.
[[nodiscard]] std::string fleet_example(const std::string& indent);

/// Estimates as read, and when the first mission began.
struct FleetEstimates {
  fleet::Fleet fleet;
  geo::GpsTime start;  ///< zero of fleet::Estimate::t
  std::size_t missions = 0;
  std::size_t units = 0;
  record::Events events;
};
/// @throws InputError
[[nodiscard]] FleetEstimates read_estimates(const FleetConfig& config);

/// What happened at one time: changes of several figures, of one unit or of many, told once.
struct FleetFinding {
  struct Part {
    std::size_t panel = 0;
    std::size_t change = 0;  ///< into FleetChanges::panels[panel].changes
  };
  std::vector<Part> parts;         ///< the most certain first
  std::vector<std::string> units;  ///< names, sorted
  double p = 1.0;                  ///< the smallest of the parts
  std::string sentence;
};

struct FleetResult {
  FleetEstimates estimates;
  fleet::FleetChanges changes;
  std::vector<fleet::PooledPanel> pooled;  ///< as Fleet::panels
  std::vector<FleetFinding> findings;      ///< the most certain first
};

[[nodiscard]] FleetResult fleet_statistics(const FleetConfig& config, const Progress& progress);
/// The same for estimates in memory.
[[nodiscard]] FleetResult fleet_statistics(const FleetConfig& config, FleetEstimates estimates, const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const FleetConfig& config);
/// pooled.csv, changes.csv, missions.csv, report.html, fleet.json (docs/schema/fleet_result.schema.json).
void write(const FleetConfig& config, const FleetResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const FleetConfig& config, const FleetResult& result, const std::filesystem::path& folder);

}  // namespace coast::jobs
