#pragma once
// The likelihood used for the fit of the noise; private to the room.

#include <atomic>
#include <functional>
#include <optional>

#include "noise_scores.hpp"

namespace coast::estimate {

/// The axes of a triad are alike: their log factors scatter about their mean with this prior's deviation.
class TriadPrior {
 public:
  explicit TriadPrior(const std::vector<NoiseParameter>& parameters);
  [[nodiscard]] double value(const Eigen::VectorXd& theta) const { return -0.5 * theta.dot(information_ * theta); }
  [[nodiscard]] NoiseScores added_to(NoiseScores scores, const Eigen::VectorXd& theta) const;

 private:
  Eigen::MatrixXd information_;
};

/// The filter's log-likelihood with an open gate and the prior, as a function of the logarithms of the free parameters.
class NoiseObjective {
 public:
  using Start = std::function<FilterState(const ForwardFilter&)>;

  /// All referenced objects must outlive it.
  /// @param fixed  values of the parameters that are not free
  NoiseObjective(const Mission& mission, const noise::ImuErrorModel& model, const FilterOptions& options,
                 const std::vector<NoiseParameter>& parameters, const NoiseAdjustment& fixed, const Start& start);

  [[nodiscard]] NoiseAdjustment at(const Eigen::VectorXd& theta) const;
  /// A pass, which is kept; minus infinity if the filter fails: worse than any other set, not an error.
  [[nodiscard]] double value(const Eigen::VectorXd& theta);
  /// At the point of the last call of value().
  [[nodiscard]] NoiseScores scores() const;
  /// Value, and scores if it is finite, by a pass that is not kept; from several threads at a time.
  [[nodiscard]] NoiseScores scores_beside(const Eigen::VectorXd& theta, double& value) const;
  [[nodiscard]] double value_beside(const Eigen::VectorXd& theta) const;
  /// An additional pass that is not kept. @throws NumericalError  the filter fails
  [[nodiscard]] FilterResult run(const NoiseAdjustment& adjustment) const;
  [[nodiscard]] const TriadPrior& prior() const { return prior_; }
  [[nodiscard]] int passes() const { return passes_; }

 private:
  [[nodiscard]] ForwardFilter filter_at(const NoiseAdjustment& adjustment) const;
  [[nodiscard]] StartSlope start_slope(Eigen::Index parameter) const;

  const Mission& mission_;
  const noise::ImuErrorModel& model_;
  FilterOptions options_;
  const std::vector<NoiseParameter>& parameters_;
  TriadPrior prior_;
  NoiseAdjustment fixed_;
  const Start& start_;
  mutable std::atomic<int> passes_{0};
  // The last pass.
  Eigen::VectorXd theta_;
  std::optional<ForwardFilter> filter_;
  PassRecord pass_;
};

}  // namespace coast::estimate
