#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "coast/study/drift.hpp"

namespace coast::jobs {

struct DriftRow {
  double duration_s = 0.0;
  std::size_t outages = 0;
  study::Drift forward;
  study::Drift smoothed;
};

/// One row per duration, in order of appearance. Outages without a smoothed solution are omitted.
[[nodiscard]] std::vector<DriftRow> drift_table(const std::vector<study::OutageResult>& outages);
/// Statistics as in summary.json and outage.json, metres.
[[nodiscard]] nlohmann::ordered_json spread_json(const study::Spread& spread);

}  // namespace coast::jobs
