#pragma once
// Progress of one stage of a run; private to the room.

#include "coast/study/mission.hpp"

namespace coast::study {

/// Tells how far `what` is. `progress` must outlive it; empty where that is.
[[nodiscard]] inline std::function<void(double)> stage(const Progress& progress, const char* what) {
  if (!progress) return {};
  return [&progress, what](double fraction) { progress(what, fraction); };
}

}  // namespace coast::study
