#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "coast/study/outage.hpp"

namespace coast::cli {

/// Quantiles of the largest horizontal error over the outages of one duration, m.
struct Drift {
  double median = 0.0;
  double p68 = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

struct DriftRow {
  double duration_s = 0.0;
  std::size_t outages = 0;
  Drift forward;
  Drift smoothed;
  std::optional<Drift> forward_against_gnss;  ///< the withheld fixes, at the antenna
  std::optional<Drift> smoothed_against_gnss;
  double inside_95 = 0.0;  ///< share of smoothed errors (axis by axis) within 1.96 predicted sigma
};

/// One row per duration, in order of appearance. Outages without a smoothed solution are left out.
[[nodiscard]] std::vector<DriftRow> drift_table(const std::vector<study::OutageResult>& outages);
/// A drift of summary.json and outage.json, metres.
[[nodiscard]] nlohmann::ordered_json drift_json(const Drift& drift);

}  // namespace coast::cli
