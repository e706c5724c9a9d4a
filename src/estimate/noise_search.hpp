#pragma once
// Search for the maximum-likelihood noise; private to the room.

#include <functional>
#include <optional>

#include "noise_scores.hpp"

namespace coast::estimate {

struct SearchBox {
  Eigen::VectorXd low, high;
};

/// A log-likelihood over the logarithms of the parameters.
struct Likelihood {
  std::function<double(const Eigen::VectorXd&)> value;  ///< minus infinity if the filter fails
  std::function<NoiseScores()> scores;                  ///< at the point of the last call of value()
  /// Value at another point, in a pass that is not kept; several threads may call it at a time.
  std::function<double(const Eigen::VectorXd&)> value_beside = {};
  std::function<NoiseScores(const Eigen::VectorXd&, double& value)> scores_beside = {};  ///< likewise
};

struct SearchPoint {
  Eigen::VectorXd theta;
  double value = 0.0;
  NoiseScores scores;
  Eigen::MatrixXd information;  ///< minus second derivatives, as far as known
};
/// Without scores if the filter fails.
[[nodiscard]] SearchPoint point_at(const Likelihood& likelihood, const Eigen::VectorXd& theta);

/// The step within [low, high] with the highest  g' s - s' B s / 2.
[[nodiscard]] Eigen::VectorXd best_step(const Eigen::VectorXd& g, const Eigen::MatrixXd& B, const Eigen::VectorXd& low,
                                        const Eigen::VectorXd& high);

/// Difference between the slopes of the likelihood and the scores, for which the linearisation point is fixed, as a linear
/// function of the point.
struct Relinearised {
  Eigen::VectorXd at;
  Eigen::VectorXd slopes;  ///< at this point
  Eigen::MatrixXd change;  ///< of the slopes with the point
};

struct SearchState {
  SearchPoint at;
  std::optional<Relinearised> beyond_scores;
  [[nodiscard]] Eigen::VectorXd slopes() const;
};

/// Quasi-Newton steps: second derivatives are the average information (`at.information` once the slopes beyond the scores are
/// known), corrected by the change of the slopes over the last steps; shorter if the likelihood decreases.
/// @param settled  minimum predicted gain of log-likelihood of a step
void climb(const Likelihood& likelihood, const SearchBox& box, double settled, SearchState& state);

/// Computes this difference of slopes from values near the point.
/// @param curvature  also second derivatives, from scores there
void relinearise(const Likelihood& likelihood, bool curvature, SearchState& state);

/// Continues to the maximum of the likelihood itself, within a thousandth of a sigma.
void polish(const Likelihood& likelihood, const SearchBox& box, SearchState& state);

}  // namespace coast::estimate
