#pragma once
// The page of a campaign: its groups beside each other.

#include <string>
#include <utility>
#include <vector>

#include "campaign/statistics.hpp"
#include "coast/jobs/campaign.hpp"
#include "coast/report/page.hpp"

namespace coast::jobs {

/// A group as numbers of fixed length: the results themselves are not kept.
struct GroupSummary {
  std::string name;  ///< mission and factors
  std::size_t units = 0, done = 0, failed = 0, missing = 0;
  std::size_t good = 0, doubtful = 0, unusable = 0;
  std::optional<study::Spread> nis_ratio;
  std::array<std::optional<study::Spread>, 2> horizontal_rms, down_rms;  ///< forward, smoothed
  struct Duration {
    double seconds = 0.0;
    std::size_t outages = 0;
    std::optional<study::Drift> forward, smoothed;
  };
  std::vector<Duration> durations;
};
[[nodiscard]] GroupSummary summary_of(const GroupStatistics& group);

struct CampaignFailure {
  std::string mission, error_model, outages, effects, error;
};

[[nodiscard]] report::Page campaign_page(const CampaignConfig& config, const CampaignCollection& all,
                                         const std::vector<GroupSummary>& groups, const std::vector<CampaignFailure>& failures);

}  // namespace coast::jobs
