#pragma once
// Statistics of the units of a group, collected unit by unit, without keeping their results.

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "campaign/unit_result.hpp"
#include "coast/study/drift.hpp"

namespace coast::jobs {

/// Drift over many outages as study::drift_of() computes it, from 64 bytes of each outage.
class DriftSums {
 public:
  void add(const study::OutageErrors& errors);
  [[nodiscard]] std::size_t outages() const { return horizontal_.size(); }
  /// At least one outage was added.
  [[nodiscard]] study::Drift drift() const;

 private:
  std::vector<double> horizontal_, against_gnss_;
  std::array<std::vector<double>, 3> largest_, end_;
  Eigen::Vector3d sigma_end_squares_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_max_squares_ = Eigen::Vector3d::Zero();
  std::size_t inside_ = 0, tested_ = 0;
};

/// Outages of one duration.
struct DurationSums {
  DriftSums forward, smoothed;
};

/// Units that differ in their missions only.
struct GroupStatistics {
  std::string mission, error_model, outages, effects;
  std::size_t units = 0, done = 0, failed = 0, missing = 0;
  std::map<std::string, std::size_t> verdicts;
  std::vector<double> nis_ratio;                                ///< mean over expected, of each unit
  std::array<std::vector<double>, 2> horizontal_rms, down_rms;  ///< of each unit against its reference; forward, smoothed
  std::map<double, DurationSums> durations;
  void add(const UnitResult& result);
};

}  // namespace coast::jobs
