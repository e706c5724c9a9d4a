#pragma once
// The search for the likeliest noise; private to the room.

#include <functional>
#include <optional>

#include "noise_scores.hpp"

namespace coast::estimate {

struct SearchBox {
  Eigen::VectorXd low, high;
};

/// A log-likelihood over the logarithms of the parameters.
struct Likelihood {
  std::function<double(const Eigen::VectorXd&)> value;  ///< minus infinity where the filter breaks
  std::function<NoiseScores()> scores;                  ///< at the point that value() was asked for last
};

struct SearchPoint {
  Eigen::VectorXd theta;
  double value = 0.0;
  NoiseScores scores;
  Eigen::MatrixXd information;  ///< minus second derivatives, as well as they are known
};
/// Without scores where the filter breaks.
[[nodiscard]] SearchPoint point_at(const Likelihood& likelihood, const Eigen::VectorXd& theta);

/// The step within [low, high] with the highest  g' s - s' B s / 2.
[[nodiscard]] Eigen::VectorXd best_step(const Eigen::VectorXd& g, const Eigen::MatrixXd& B, const Eigen::VectorXd& low,
                                        const Eigen::VectorXd& high);

/// What the likelihood's own slopes are beyond the scores, which hold the linearisation fast, as a linear function of the
/// point.
struct Relinearised {
  Eigen::VectorXd at;
  Eigen::VectorXd slopes;  ///< there
  Eigen::MatrixXd change;  ///< of the slopes with the point
};

struct SearchState {
  SearchPoint at;
  std::optional<Relinearised> beyond_scores;
  [[nodiscard]] Eigen::VectorXd slopes() const;
};

/// Quasi-Newton steps: second derivatives are the average information (`at.information` once the slopes beyond the scores are
/// known), corrected by what the slopes did over the last steps; shorter where the likelihood falls.
/// @param settled  log-likelihood that a step must promise
void climb(const Likelihood& likelihood, const SearchBox& box, double settled, SearchState& state);

/// Finds the slopes beyond the scores by values beside the point.
/// @param curvature  and second derivatives, by scores there
void relinearise(const Likelihood& likelihood, bool curvature, SearchState& state);

/// Goes on to where the likelihood itself is highest, within a thousandth of a sigma.
void polish(const Likelihood& likelihood, const SearchBox& box, SearchState& state);

}  // namespace coast::estimate
