#pragma once
// What may be wrong with how a recording is read; private to the room.

#include <functional>
#include <string>
#include <vector>

#include "coast/study/causes.hpp"

namespace coast::study {

/// What a hypothesis changes, and how it is told.
struct CauseHypothesis {
  std::string what;
  std::string remedy;
  std::function<void(Excerpt&, Setup&)> apply;
};

/// Prior sigmas that leave time offset and lever arm to the data, s and m.
constexpr double kFreeTimeSd = 0.5, kFreeArmSd = 1.0;

/// All of them; a new one is a line in the source.
[[nodiscard]] std::vector<CauseHypothesis> cause_hypotheses();

}  // namespace coast::study
