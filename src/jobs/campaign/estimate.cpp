// What a campaign will need: one unit of each kind of mission and each set of outages is run, the rest is in proportion.

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numeric>

#include "campaign/run_unit.hpp"

namespace coast::jobs {

namespace {

std::uintmax_t bytes_below(const std::filesystem::path& folder) {
  std::uintmax_t bytes = 0;
  std::error_code none;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, none))
    if (entry.is_regular_file(none)) bytes += entry.file_size(none);
  return bytes;
}

/// Sizes of the missions of a group: all of them, the largest, and which is the smallest.
struct Extents {
  double sum = 0.0, largest = 0.0, smallest = 0.0;
  std::size_t smallest_unit = 0;
};

Extents extents_of(Campaign& campaign, const CampaignGroup& group) {
  Extents extents;
  std::string wrong;
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    const CampaignUnit unit = campaign.unit(i);
    double extent = 0.0;
    try {
      extent = campaign.extent(unit);
    } catch (const InputError& error) {  // it will fail in a moment
      wrong = error.what();
      continue;
    }
    if (extents.sum == 0.0 || extent < extents.smallest) {
      extents.smallest = extent;
      extents.smallest_unit = i;
    }
    extents.sum += extent;
    extents.largest = std::max(extents.largest, extent);
    if (campaign.mission(unit).scenario != nullptr) {  // all seeds are alike
      extents.sum *= static_cast<double>(group.count);
      break;
    }
  }
  if (extents.sum == 0.0) throw InputError({campaign.config().file.string(), 0, wrong, "", ""});
  return extents;
}

CampaignEstimate::Kind estimated(Campaign& campaign, const CampaignGroup& group, std::size_t units) {
  CampaignEstimate::Kind kind;
  kind.mission = campaign.kinds()[group.kind].name;
  kind.outages = campaign.outages(group.outages);
  kind.units = units;
  try {
    const Extents extents = extents_of(campaign, group);
    const CampaignUnit trial = campaign.unit(extents.smallest_unit);
    UnitOutcome outcome;
    tbb::task_arena one(1);  // seconds of one processor
    one.execute([&] { outcome = run_unit(campaign, trial, true); });
    kind.failure = outcome.error;
    const double ratio = extents.largest / extents.smallest;
    const double missions = extents.sum / extents.smallest;
    kind.seconds = outcome.cost.seconds * missions * static_cast<double>(units) / static_cast<double>(group.count);
    kind.longest_s = outcome.cost.seconds * ratio;
    kind.memory_bytes = outcome.cost.memory_bytes * ratio;
    kind.result_bytes =
        static_cast<double>(bytes_below(campaign.store().folder_of(campaign.key(trial)))) * static_cast<double>(units);
  } catch (const InputError& error) {
    kind.failure = error.what();
  }
  return kind;
}

}  // namespace

double CampaignEstimate::seconds() const {
  return std::accumulate(kinds.begin(), kinds.end(), 0.0, [](double sum, const Kind& kind) { return sum + kind.seconds; });
}
double CampaignEstimate::memory_bytes() const {
  double most = 0.0;
  for (const Kind& kind : kinds) most = std::max(most, kind.memory_bytes);
  return most;
}
double CampaignEstimate::result_bytes() const {
  return std::accumulate(kinds.begin(), kinds.end(), 0.0, [](double sum, const Kind& kind) { return sum + kind.result_bytes; });
}
double CampaignEstimate::shard_seconds() const {
  double longest = 0.0;
  for (const Kind& kind : kinds) longest = std::max(longest, kind.longest_s);
  return seconds() / static_cast<double>(shards) + longest;
}

CampaignEstimate estimate_campaign(const CampaignConfig& config, const std::filesystem::path& out, const Progress& progress) {
  Campaign campaign(config, out);
  campaign.store().remove_unfinished();
  CampaignEstimate estimate;
  estimate.units = campaign.size();
  estimate.shards = config.shards;
  const std::size_t each =
      std::max<std::size_t>(1, config.error_models.size()) * std::max<std::size_t>(1, config.effects.size());
  for (std::size_t i = 0; i < campaign.groups(); ++i) {
    const CampaignGroup group = campaign.group(i);
    if (group.error_model > 0 || group.effects > 0) continue;  // of the same cost
    progress("trying one of each kind", static_cast<double>(i) / static_cast<double>(campaign.groups()));
    estimate.kinds.push_back(estimated(campaign, group, each * group.count));
  }
  campaign.remember_digests();
  return estimate;
}

std::string told(const CampaignEstimate& estimate) {
  std::string text;
  for (const CampaignEstimate::Kind& kind : estimate.kinds) {
    const std::string what = kind.outages.empty() ? kind.mission : fmt::format("{}, outages {}", kind.mission, kind.outages);
    if (kind.failure.empty())
      text += fmt::format("{}: {} units, {:.3g} s of one processor, {:.0f} MB of memory for one, {:.3g} MB of results\n", what,
                          kind.units, kind.seconds, kind.memory_bytes / 1e6, kind.result_bytes / 1e6);
    else
      text += fmt::format("{}: {} units, and the one that was tried failed: {}\n", what, kind.units, kind.failure);
  }
  return text + fmt::format(
                    "{} units in {} shards: {:.3g} s of one processor, {:.3g} s for a shard, {:.0f} MB of memory for a "
                    "unit, {:.3g} MB of results\n",
                    estimate.units, estimate.shards, estimate.seconds(), estimate.shard_seconds(),
                    estimate.memory_bytes() / 1e6, estimate.result_bytes() / 1e6);
}

}  // namespace coast::jobs
