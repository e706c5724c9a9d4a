// The units of a shard: computed where their results are not there; and how far a campaign is.

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

#include "campaign/run_unit.hpp"
#include "coast/parallel.hpp"

namespace coast::jobs {

namespace {

constexpr std::size_t kTold = 20;  // failures with their errors on the terminal; all of them are collected

std::string described(const Campaign& campaign, const CampaignUnit& unit) {
  std::string text = campaign.mission(unit).name;
  for (const std::string& factor :
       {campaign.error_model(unit.error_model), campaign.outages(unit.outages), campaign.effects(unit.effects)})
    if (!factor.empty()) text += ", " + factor;
  return text;
}

/// Counts what becomes of the units, which come from several threads.
class Counter {
 public:
  Counter(const Campaign& campaign, std::size_t units, const Progress& progress) : campaign_(campaign), progress_(progress) {
    run_.units = units;
  }

  void add(const CampaignUnit& unit, const UnitOutcome& outcome) {
    const std::scoped_lock lock(mutex_);
    using State = UnitOutcome::State;
    if (outcome.state == State::kFound) ++run_.found;
    if (outcome.state == State::kDone || outcome.state == State::kFailed) ++run_.computed;
    if (outcome.state == State::kFailed) ++run_.failed;
    if (outcome.state == State::kUnwritten) ++run_.unwritten;
    if (!outcome.error.empty() && run_.failures.size() < kTold)
      run_.failures.push_back(fmt::format("{}: {}", described(campaign_, unit), outcome.error));
    progress_("units", static_cast<double>(++done_) / static_cast<double>(run_.units));
  }
  void add_known_failure(const CampaignUnit& unit, const std::string& error) {
    const std::scoped_lock lock(mutex_);
    ++run_.failed;
    if (run_.failures.size() < kTold) run_.failures.push_back(fmt::format("{}: {}", described(campaign_, unit), error));
  }
  [[nodiscard]] CampaignRun take() { return std::move(run_); }

 private:
  const Campaign& campaign_;
  const Progress& progress_;
  std::mutex mutex_;
  CampaignRun run_;
  std::size_t done_ = 0;
};

/// A result that is there, unless failed ones are to be tried again.
std::optional<UnitOutcome> found(Campaign& campaign, const CampaignUnit& unit, bool again, Counter& counter) {
  try {
    if (!is_done(campaign, unit)) return std::nullopt;
    if (!has_failed(campaign, unit)) return UnitOutcome{UnitOutcome::State::kFound, {}, {}};
    if (again) {
      campaign.store().remove(campaign.key(unit));
      return std::nullopt;
    }
    std::string error = campaign.store().read(campaign.key(unit), kError).value_or("");
    while (error.ends_with('\n')) error.pop_back();
    counter.add_known_failure(unit, error);
    return UnitOutcome{UnitOutcome::State::kFound, {}, {}};
  } catch (const InputError&) {
    return std::nullopt;  // run_unit tells it
  }
}

}  // namespace

CampaignRun run_campaign(const CampaignConfig& config, const std::filesystem::path& out, Shard shard, bool again,
                         const Progress& progress) {
  Campaign campaign(config, out);
  campaign.store().remove_unfinished();
  std::vector<std::size_t> own;
  for (std::size_t i = shard.index - 1; i < campaign.size(); i += shard.count) own.push_back(i);
  Counter counter(campaign, own.size(), progress);
  coast::parallel_for(std::size_t{0}, own.size(), [&](std::size_t i) {
    // A thread that waits inside one unit must not begin another: each needs its own memory.
    tbb::this_task_arena::isolate([&] {
      const CampaignUnit unit = campaign.unit(own[i]);
      const std::optional<UnitOutcome> known = found(campaign, unit, again, counter);
      counter.add(unit, known ? *known : run_unit(campaign, unit, false));
    });
  });
  campaign.remember_digests();
  return counter.take();
}

CampaignStatus campaign_status(const CampaignConfig& config, const std::filesystem::path& out, std::size_t shards) {
  constexpr std::size_t kTimed = 200;  // results whose cost is read
  Campaign campaign(config, out);
  CampaignStatus status;
  status.shards.resize(std::max<std::size_t>(1, shards));
  std::size_t timed = 0;
  double seconds = 0.0;
  for (std::size_t i = 0; i < campaign.size(); ++i) {
    CampaignStatus::OfShard& shard = status.shards[i % status.shards.size()];
    ++shard.units;
    const CampaignUnit unit = campaign.unit(i);
    try {
      if (!is_done(campaign, unit)) continue;
      ++(has_failed(campaign, unit) ? shard.failed : shard.done);
    } catch (const InputError&) {
      ++shard.failed;
      continue;
    }
    if (timed >= kTimed) continue;
    const auto cost = cost_from(campaign.store().read(campaign.key(unit), kResult).value_or(""));
    if (!cost) continue;
    seconds += cost->seconds;
    ++timed;
  }
  if (timed > 0) status.seconds_each = seconds / static_cast<double>(timed);
  campaign.remember_digests();
  return status;
}

std::string told(const CampaignStatus& status) {
  std::string text;
  CampaignStatus::OfShard all;
  double longest = 0.0;
  for (std::size_t i = 0; i < status.shards.size(); ++i) {
    const CampaignStatus::OfShard& shard = status.shards[i];
    const std::size_t left = shard.units - shard.done - shard.failed;
    if (status.shards.size() > 1)
      text += fmt::format("shard {}/{}: {} units, {} done, {} failed, {} left\n", i + 1, status.shards.size(), shard.units,
                          shard.done, shard.failed, left);
    all.units += shard.units;
    all.done += shard.done;
    all.failed += shard.failed;
    longest = std::max(longest, static_cast<double>(left) * status.seconds_each);
  }
  const std::size_t left = all.units - all.done - all.failed;
  text += fmt::format("{} units: {} done, {} failed, {} left\n", all.units, all.done, all.failed, left);
  if (left > 0 && status.seconds_each > 0.0)
    text += fmt::format("{:.2g} s for one: {:.3g} s of one processor left, {:.3g} s with one for each shard\n",
                        status.seconds_each, static_cast<double>(left) * status.seconds_each, longest);
  return text;
}

}  // namespace coast::jobs
