#pragma once
// Progress of one stage of a run; private to the room.

#include "coast/study/mission.hpp"

namespace coast::study {

/// Reports the progress of `what`. `progress` must outlive it; empty if `progress` is.
[[nodiscard]] inline std::function<void(double)> stage(const Progress& progress, const char* what) {
  if (!progress) return {};
  return [&progress, what](double fraction) { progress(what, fraction); };
}

}  // namespace coast::study
