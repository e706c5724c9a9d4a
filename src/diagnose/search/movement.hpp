#pragma once
// A joint Gauss-Newton step of the sizes of selected effects; private to the room.

#include <vector>

#include "search/explained_run.hpp"

namespace coast::diagnose {

/// Rows of the selected effects in an examination. @param hypotheses  their number
[[nodiscard]] std::vector<Eigen::Index> rows_of(const std::vector<SelectedEffect>& effects, Eigen::Index hypotheses);

/// Changes of sizes by the remaining effects in a run, and their standard deviations.
struct Movement {
  Eigen::VectorXd by, sd;
  /// Largest change, in standard deviations.
  [[nodiscard]] double farthest() const;
};
[[nodiscard]] Movement movement(const SizeEvidence& evidence);

/// @param share  of the step
[[nodiscard]] Explanation moved(Explanation explanation, const Movement& step, double share = 1.0);

/// The explanation of a run with the sizes estimated in the run.
[[nodiscard]] inline Explanation followed(const ExplainedRun& run) {
  return moved(run.explanation(), movement(run.sizes()));
}

}  // namespace coast::diagnose
