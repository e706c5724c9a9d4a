#pragma once
// Parts of the tables and the page of an outage study.

#include <nlohmann/json.hpp>

#include "coast/jobs/outage.hpp"
#include "coast/report/page.hpp"

namespace coast::jobs {

/// Two runs over the same outages whose errors are compared pair by pair.
struct StudyPair {
  const study::ModelRun* first;
  const study::ModelRun* second;
  bool floor = false;  ///< the second is a floor: less noise in its recordings, not another error model
};
/// For each truth, its first error model with each further one, then with each floor.
[[nodiscard]] std::vector<StudyPair> pairs_of(const OutageStudy& study);

/// Outages of one manoeuvre class among those of a group.
struct ManoeuvreDrift {
  study::Manoeuvre manoeuvre;
  std::vector<study::OutageResult> outages;
};
/// Occurring classes, in the order of study::Manoeuvre.
[[nodiscard]] std::vector<ManoeuvreDrift> by_manoeuvre(const std::vector<study::OutageResult>& outages);

/// Statistics of one solution as in outage.json and campaign.json.
[[nodiscard]] nlohmann::ordered_json drift_json(const study::Drift& drift);
/// outage.json
[[nodiscard]] nlohmann::ordered_json outage_json(const OutageStudy& study);
/// outages.csv: one line per outage and error model.
[[nodiscard]] std::string outages_csv(const OutageStudy& study);

// --- the page: page_study_durations.cpp, page_study_group.cpp

/// As functions of duration: drift, prediction, gain of the smoother; by manoeuvre.
void add_durations(const OutageStudy& study, report::Page& page);
/// Tiles, and a section for each group of outages and each truth.
void add_groups(const OutageStudy& study, report::Page& page);

}  // namespace coast::jobs
