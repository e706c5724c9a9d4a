#pragma once
// Possible errors in the interpretation of a recording; private to the room.

#include <functional>
#include <string>
#include <vector>

#include "coast/study/causes.hpp"

namespace coast::study {

/// Change of the setup by a hypothesis, and its description.
struct CauseHypothesis {
  std::string what;
  std::string remedy;
  std::function<void(Excerpt&, Setup&)> apply;
  bool of_samples = true;  ///< signs, axes and units; not antenna and time
};

/// Prior sigmas with which time offset and lever arm are determined by the data, s and m.
constexpr double kFreeTimeSd = 0.5, kFreeArmSd = 1.0;

/// All of them; a new one is a line in the source.
[[nodiscard]] std::vector<CauseHypothesis> cause_hypotheses();

}  // namespace coast::study
