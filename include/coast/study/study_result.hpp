#pragma once
// Result of a study of outages: every outage of every error model.

#include <string>
#include <vector>

#include "coast/study/drift.hpp"
#include "coast/study/paired.hpp"

namespace coast::study {

/// Outages of one duration, at one or more times of a mission.
struct OutageGroup {
  double duration_s = 0.0;
  std::vector<double> starts_s;  ///< since the start of the mission
};

/// The outages of a sweep over a mission of some length: one group for each duration that fits.
[[nodiscard]] std::vector<OutageGroup> grouped(const OutageSweep& sweep, double mission_s);

/// One error model on the recordings of one truth, or on the one real recording.
struct ModelRun {
  std::string truth;   ///< error model of the simulated sensors; empty: a real recording
  std::string filter;  ///< error model of the filter
  /// [group]: start by start, within it seed by seed. Series (for figures) are stored for the first outage of a group only.
  std::vector<std::vector<OutageResult>> outages;
};

struct StudyResult {
  std::vector<OutageGroup> groups;
  std::size_t seeds = 1;  ///< recordings
  std::vector<ModelRun> runs;
};

/// Errors of `second` relative to those of `first`, outage by outage. Overlapping outages of one recording are correlated; the
/// interval takes this into account (paired_ratio).
[[nodiscard]] PairedRatio compare(const StudyResult& study, const ModelRun& first, const ModelRun& second, std::size_t group,
                                  DriftMeasure measure, bool smoothed);

}  // namespace coast::study
