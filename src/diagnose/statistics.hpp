#pragma once
// What a run shows, in figures that twins have too; private to the room.

#include <optional>
#include <string>
#include <vector>

#include "coast/diagnose/examination.hpp"
#include "mission_run.hpp"

namespace coast::diagnose {

struct Statistic {
  std::string name;
  double value = 0.0;
  std::optional<Stretch> stretch = {};
};
/// NIS and whiteness of innovations, NIS of tenths of the mission, of regimes against the rest, disturbances of every axis over
/// seconds and minutes, the largest likelihood ratios, drift in artificial outages. The same figures in the same order for
/// every run.
[[nodiscard]] std::vector<Statistic> statistics_of(const MissionRun& run, const Examination& examination);

/// The recording among its twins.
[[nodiscard]] std::vector<TwinStatistic> against(const std::vector<Statistic>& real,
                                                 const std::vector<std::vector<Statistic>>& twins);

/// The figures of an input by the pipeline that the search begins with: twice, the second time from a loosened start.
[[nodiscard]] std::vector<Statistic> statistics_of(const MissionInput& input, std::uint64_t seed);

}  // namespace coast::diagnose
