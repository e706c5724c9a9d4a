#include "coast/study/study_result.hpp"

namespace coast::study {

std::vector<OutageGroup> grouped(const OutageSweep& sweep, double mission_s) {
  std::vector<OutageGroup> groups;
  const geo::GpsTime start;
  for (const Outage& outage : outages_of(sweep, start, start + mission_s)) {
    if (groups.empty() || groups.back().duration_s != outage.duration_s) groups.push_back({outage.duration_s, {}});
    groups.back().starts_s.push_back(outage.start - start);
  }
  return groups;
}

PairedRatio compare(const StudyResult& study, const ModelRun& first, const ModelRun& second, std::size_t group,
                    DriftMeasure measure, bool smoothed) {
  const OutageGroup& outages = study.groups[group];
  constexpr double kApart = 1e9;  // s between recordings
  std::vector<double> times;
  for (const double start : outages.starts_s)
    for (std::size_t seed = 0; seed < study.seeds; ++seed) times.push_back(start + kApart * static_cast<double>(seed));
  return paired_ratio(drifts(first.outages[group], measure, smoothed), drifts(second.outages[group], measure, smoothed), times,
                      outages.duration_s);
}

}  // namespace coast::study
