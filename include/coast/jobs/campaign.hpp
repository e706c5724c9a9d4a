#pragma once
// Many missions, each with every error model, every set of outages and every set of effects: one run each, on one machine or on
// many, with results that are kept, found again, and merged.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/jobs/job.hpp"

namespace coast::jobs {

enum class CampaignJob { kProcess, kOutage, kDiagnose };
[[nodiscard]] const char* name(CampaignJob job);

/// plan.yaml
struct CampaignConfig {
  std::filesystem::path file;
  CampaignJob job = CampaignJob::kProcess;
  int twins = 20;      ///< of diagnose
  bool quick = false;  ///< likewise

  /// Recorded missions: the run files that an entry of the plan names.
  struct Recorded {
    std::string name;  ///< as in the plan
    std::vector<std::filesystem::path> runs;
  };
  std::vector<Recorded> recorded;
  /// Simulated missions: one for each seed.
  struct Simulated {
    std::string name;
    std::filesystem::path scenario;
    std::optional<std::filesystem::path> error_model;  ///< of the sensors, in place of the scenario's
  };
  std::vector<Simulated> simulated;
  std::uint64_t first_seed = 1;
  std::size_t seeds = 0;

  struct ErrorModel {
    std::string name;
    std::filesystem::path file;
  };
  /// A value of a key of the run file, in place of the run's own; null: none.
  struct Choice {
    std::string name;
    std::optional<config::Node> value;
  };
  std::vector<ErrorModel> error_models;  ///< empty: the run's own
  std::vector<Choice> outages;           ///< empty: the run's own
  std::vector<Choice> effects;           ///< empty: the run's own

  std::vector<std::string> keep;  ///< files of the job that are kept besides the summary
  std::size_t shards = 1;         ///< for the scripts of `submit`
};
/// @throws InputError  anything missing, out of range or unknown, with file and line; an entry that names no run file
[[nodiscard]] CampaignConfig read_campaign(const std::filesystem::path& file);

/// Part of the units: those whose number leaves this rest.
struct Shard {
  std::size_t index = 1;  ///< 1 to count
  std::size_t count = 1;
};
/// "3/40".  @throws InputError
[[nodiscard]] Shard shard_from(const std::string& text);

struct CampaignRun {
  std::size_t units = 0;                   ///< of the shard
  std::size_t found = 0;                   ///< results that were there
  std::size_t computed = 0;                ///< now
  std::size_t failed = 0;                  ///< of all of the shard: bad input, or numbers that failed
  std::size_t unwritten = 0;               ///< computed or not, without a result: the disk, the memory
  std::vector<std::string> failures = {};  ///< the first of them, with their errors
};
/// Computes the results of a shard that are not there, several at a time; whatever fails is recorded and does not end the rest.
[[nodiscard]] CampaignRun run_campaign(const CampaignConfig& config, const std::filesystem::path& out, Shard shard, bool again,
                                       const Progress& progress);

struct CampaignStatus {
  struct OfShard {
    std::size_t units = 0, done = 0, failed = 0;
  };
  std::vector<OfShard> shards;
  double seconds_each = 0.0;  ///< mean over the results that are there; 0: none
};
[[nodiscard]] CampaignStatus campaign_status(const CampaignConfig& config, const std::filesystem::path& out,
                                             std::size_t shards);
[[nodiscard]] std::string told(const CampaignStatus& status);

/// What the units of a campaign will need, from one of each kind of mission and each set of outages.
struct CampaignEstimate {
  struct Kind {
    std::string mission, outages;
    std::size_t units = 0;
    double seconds = 0.0;       ///< of one processor, all units
    double longest_s = 0.0;     ///< the longest unit
    double memory_bytes = 0.0;  ///< of the largest unit
    double result_bytes = 0.0;  ///< all units
    std::string failure = {};   ///< of the trial
  };
  std::vector<Kind> kinds;
  std::size_t units = 0;
  std::size_t shards = 1;
  [[nodiscard]] double seconds() const;
  [[nodiscard]] double memory_bytes() const;  ///< the largest unit
  [[nodiscard]] double result_bytes() const;
  [[nodiscard]] double shard_seconds() const;  ///< of one shard on one processor
};
[[nodiscard]] CampaignEstimate estimate_campaign(const CampaignConfig& config, const std::filesystem::path& out,
                                                 const Progress& progress);
[[nodiscard]] std::string told(const CampaignEstimate& estimate);

struct CampaignCollection {
  std::size_t units = 0, done = 0, failed = 0, missing = 0;
};
/// Merges the results there are: missions.csv, outages.csv, estimates.csv, campaign.json, report.html. The same bytes whatever
/// machines have computed them, in whatever order, shards and attempts.
[[nodiscard]] CampaignCollection collect_campaign(const CampaignConfig& config, const std::filesystem::path& out,
                                                  const Progress& progress);
[[nodiscard]] std::vector<std::string> files_of(const CampaignConfig& config);
[[nodiscard]] std::string told(const CampaignCollection& collection, const std::filesystem::path& out);

enum class CampaignEngine { kSlurm, kParallel, kSnakemake };
/// Files with which an engine runs the shards and then collects, in `out`.
/// @return  the command that starts them
[[nodiscard]] std::string write_submission(const CampaignConfig& config, const std::filesystem::path& out,
                                           CampaignEngine engine, const CampaignEstimate& estimate);

}  // namespace coast::jobs
