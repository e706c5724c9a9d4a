#include "common/drift.hpp"

#include <algorithm>

namespace coast::jobs {

std::vector<DriftRow> drift_table(const std::vector<study::OutageResult>& outages) {
  std::vector<std::vector<study::OutageResult>> groups;
  for (const study::OutageResult& outage : outages) {
    if (!outage.smoothed) continue;
    const auto same = [&](const auto& group) { return group.front().outage.duration_s == outage.outage.duration_s; };
    const auto group = std::ranges::find_if(groups, same);
    if (group == groups.end())
      groups.push_back({outage});
    else
      group->push_back(outage);
  }
  std::vector<DriftRow> rows;
  for (const auto& group : groups)
    rows.push_back(
        {group.front().outage.duration_s, group.size(), study::drift_of(group, false), study::drift_of(group, true)});
  return rows;
}

nlohmann::ordered_json spread_json(const study::Spread& spread) {
  return {
      {"median_m", spread.median}, {"p68_m", spread.p68}, {"p95_m", spread.p95}, {"max_m", spread.max}, {"rms_m", spread.rms}};
}

}  // namespace coast::jobs
