#pragma once
// Statistics of a run, for comparison with those of twins; private to the room.

#include <optional>
#include <string>
#include <vector>

#include "coast/diagnose/examination.hpp"
#include "evidence/mission_run.hpp"

namespace coast::diagnose {

struct Statistic {
  std::string name;
  double value = 0.0;
  std::optional<Stretch> stretch = {};
};
/// NIS and whiteness of innovations, NIS of tenths of the mission, of regimes relative to the rest, disturbances of all axes
/// over seconds and minutes, the largest likelihood ratios, drift in artificial outages. The same quantities in the same order
/// for every run.
[[nodiscard]] std::vector<Statistic> statistics_of(const MissionRun& run, const Examination& examination);

}  // namespace coast::diagnose
