#pragma once
// The units of a campaign, in order, and their keys.

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coast/config/derived.hpp"
#include "coast/io/file_digests.hpp"
#include "coast/io/result_store.hpp"
#include "coast/jobs/campaign.hpp"

namespace coast::jobs {

/// One mission: a run file, or a seed of a scenario.
struct CampaignMission {
  std::string name;                                     ///< the same on every machine
  std::filesystem::path run;                            ///< of a recorded one
  const CampaignConfig::Simulated* scenario = nullptr;  ///< of a simulated one
  std::uint64_t seed = 0;
};

/// Missions of one entry of the plan.
struct MissionKind {
  std::string name;
  std::size_t first = 0;  ///< index of its first mission
  std::size_t count = 0;
};

/// Indices of what one unit combines.
struct CampaignUnit {
  std::size_t kind = 0, mission = 0, error_model = 0, outages = 0, effects = 0;
};

/// The same for all units of a group; they differ in their missions.
struct CampaignGroup {
  std::size_t kind = 0, error_model = 0, outages = 0, effects = 0;
  std::size_t first = 0, count = 0;  ///< units
};

/// The units of a campaign: group by group, within it mission by mission.
class Campaign {
 public:
  /// @param config  must outlive it
  Campaign(const CampaignConfig& config, const std::filesystem::path& out);

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] CampaignUnit unit(std::size_t index) const;
  [[nodiscard]] CampaignGroup group(std::size_t index) const;
  [[nodiscard]] std::size_t groups() const;
  [[nodiscard]] const CampaignMission& mission(const CampaignUnit& unit) const { return missions_[unit.mission]; }
  [[nodiscard]] const std::vector<MissionKind>& kinds() const { return kinds_; }
  [[nodiscard]] const CampaignConfig& config() const { return config_; }
  [[nodiscard]] const io::ResultStore& store() const { return store_; }

  // Names of the values of the factors; empty where the plan has no such factor.
  [[nodiscard]] std::string error_model(std::size_t index) const;
  [[nodiscard]] std::string outages(std::size_t index) const;
  [[nodiscard]] std::string effects(std::size_t index) const;

  /// The run file of a unit with the values of its factors.
  /// @param run  the file of a recorded mission, or of a simulated one that has been written
  [[nodiscard]] config::Node run_tree(const std::filesystem::path& run, const CampaignUnit& unit) const;
  /// The scenario of a unit, with its error model.
  [[nodiscard]] config::Node scenario_tree(const CampaignMission& mission) const;

  /// What a unit is computed from, as 64 hexadecimal digits: contents of all its input files, configuration, version of coast.
  /// May be called by several threads.  @throws InputError  a file is missing, or the configuration is wrong
  [[nodiscard]] std::string key(const CampaignUnit& unit);
  /// Bytes of the input files of a unit, or seconds of a simulated one: what its time and memory are in proportion to.
  [[nodiscard]] double extent(const CampaignUnit& unit);
  void remember_digests() { digests_.save(); }

  /// A message without folders of this machine.
  /// @param own  a folder of the unit's own, whose name it leaves out
  [[nodiscard]] std::string portable(std::string text, const std::filesystem::path& own) const;

 private:
  struct Identity {
    std::string digest;
    double extent = 0.0;
  };
  [[nodiscard]] std::string mission_name(const std::filesystem::path& run) const;
  [[nodiscard]] std::vector<config::Replacement> replacements(const CampaignUnit& unit) const;
  [[nodiscard]] const Identity& identity(const CampaignUnit& unit);
  [[nodiscard]] Identity recorded_identity(const CampaignUnit& unit);
  [[nodiscard]] Identity simulated_identity(const CampaignMission& mission);
  [[nodiscard]] std::string choice_digest(const std::vector<CampaignConfig::Choice>& choices, std::size_t index) const;

  const CampaignConfig& config_;
  io::ResultStore store_;
  io::FileDigests digests_;
  std::vector<CampaignMission> missions_;
  std::vector<MissionKind> kinds_;
  std::mutex mutex_;
  std::vector<std::optional<Identity>> identities_;           ///< of recorded missions, by mission; of simulated ones, by kind
  std::vector<std::pair<std::string, std::string>> folders_;  ///< of this machine, and what stands for them in messages
};

}  // namespace coast::jobs
