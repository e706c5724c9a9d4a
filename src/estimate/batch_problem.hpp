#pragma once
// The least-squares problem of a mission: linearised and gathered into normal equations; private to the room.

#include <vector>

#include "batch_unknowns.hpp"
#include "chain_matrix.hpp"
#include "coast/estimate/batch_smoother.hpp"
#include "propagation.hpp"

namespace coast::estimate {

/// Estimates at all knots.
struct BatchStates {
  std::vector<record::NavState> nav;
  std::vector<Eigen::VectorXd> x;  ///< size of the layout
};

class BatchProblem {
 public:
  BatchProblem(const Mission& mission, const StateLayout& layout, const FilterOptions& options, const FilterState& start,
               const KnotStore& knots, const std::vector<KnotMeasurement>& measurements, const RobustLoss& loss);

  /// The filtered states; those that are one for the mission as they are at its end, which knows most.
  [[nodiscard]] BatchStates filtered() const;
  /// Linearises everything at the states: normal() d = right(), with d the errors of the states.
  /// @return  cost
  double linearise(const BatchStates& states);
  /// Takes errors out of the states.
  void remove(const Eigen::VectorXd& d, BatchStates& states) const;
  /// Covariance of all states at a knot from that of its unknowns and of the border.
  [[nodiscard]] Eigen::MatrixXd covariance_at(std::size_t knot, const Eigen::MatrixXd& of_unknowns) const;
  /// Rows of the normal equations that covariance_at wants.
  [[nodiscard]] std::vector<Eigen::Index> rows_of(std::size_t knot) const;

  [[nodiscard]] const ChainMatrix& normal() const { return normal_; }
  [[nodiscard]] const Eigen::VectorXd& right() const { return right_; }
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

 private:
  void add_prior(const BatchStates& states);
  void add_measurements(std::size_t knot, const BatchStates& states, const SampleCursor& cursor, const Navigator& navigator);
  void add_transition(std::size_t knot, const BatchStates& states, const Propagation& arrived, const Eigen::MatrixXd& Q);
  /// Equations J d = target of the errors of all states at a knot, whitened.
  void add_equations(std::size_t knot, const Eigen::MatrixXd& J, const Eigen::VectorXd& target);
  [[nodiscard]] Eigen::MatrixXd full_transition(const Propagation& arrived);
  /// States that are one for the mission, at a knot from those at the start.
  [[nodiscard]] Eigen::MatrixXd moved(std::size_t knot) const;
  [[nodiscard]] bool is_in(const KnotMeasurement& m) const;

  const Mission& mission_;
  const StateLayout& layout_;
  const FilterOptions& options_;
  const FilterState& start_;
  const KnotStore& knots_;
  const std::vector<KnotMeasurement>& measurements_;
  RobustLoss loss_;
  mutable BatchUnknowns unknowns_;  ///< keeps the interval it was last asked for
  BlockTransitions blocks_;
  ChainMatrix normal_;
  Eigen::VectorXd right_;
  std::vector<double> weights_;
  std::size_t next_measurement_ = 0;
  double cost_ = 0.0;
};

}  // namespace coast::estimate
