#include "drift.hpp"

#include <algorithm>

#include "coast/study/paired.hpp"

namespace coast::cli {

namespace {

Drift drift_of(const std::vector<double>& values) {
  return {study::quantile(values, 0.5), study::quantile(values, 0.68), study::quantile(values, 0.95),
          study::quantile(values, 1.0)};
}

DriftRow row_of(const std::vector<const study::OutageResult*>& outages) {
  std::vector<double> forward;
  std::vector<double> smoothed;
  std::vector<double> forward_gnss;
  std::vector<double> smoothed_gnss;
  double inside = 0.0;
  double tested = 0.0;
  for (const study::OutageResult* o : outages) {
    forward.push_back(o->forward.horizontal_max_m);
    smoothed.push_back(o->smoothed->horizontal_max_m);
    if (o->forward.gnss_horizontal_max_m) forward_gnss.push_back(*o->forward.gnss_horizontal_max_m);
    if (o->smoothed->gnss_horizontal_max_m) smoothed_gnss.push_back(*o->smoothed->gnss_horizontal_max_m);
    inside += static_cast<double>(o->smoothed->inside_95);
    tested += static_cast<double>(o->smoothed->tested);
  }
  DriftRow row;
  row.duration_s = outages.front()->outage.duration_s;
  row.outages = outages.size();
  row.forward = drift_of(forward);
  row.smoothed = drift_of(smoothed);
  if (!forward_gnss.empty()) row.forward_against_gnss = drift_of(forward_gnss);
  if (!smoothed_gnss.empty()) row.smoothed_against_gnss = drift_of(smoothed_gnss);
  if (tested > 0.0) row.inside_95 = inside / tested;
  return row;
}

}  // namespace

std::vector<DriftRow> drift_table(const std::vector<study::OutageResult>& outages) {
  std::vector<std::vector<const study::OutageResult*>> groups;
  for (const study::OutageResult& outage : outages) {
    if (!outage.smoothed) continue;
    const auto same = [&](const auto& group) { return group.front()->outage.duration_s == outage.outage.duration_s; };
    const auto group = std::ranges::find_if(groups, same);
    if (group == groups.end())
      groups.push_back({&outage});
    else
      group->push_back(&outage);
  }
  std::vector<DriftRow> rows;
  for (const auto& group : groups) rows.push_back(row_of(group));
  return rows;
}

nlohmann::ordered_json drift_json(const Drift& drift) {
  return {{"median_m", drift.median}, {"p68_m", drift.p68}, {"p95_m", drift.p95}, {"max_m", drift.max}};
}

}  // namespace coast::cli
