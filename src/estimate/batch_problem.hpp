#pragma once
// The least-squares problem of a mission: linearised, as normal equations; private to the room.

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
  /// @throws NumericalError  more memory needed than allowed
  BatchProblem(const Mission& mission, const StateLayout& layout, const FilterOptions& options, const FilterState& start,
               const KnotStore& knots, const std::vector<KnotMeasurement>& measurements, const BatchOptions& batch);

  /// The filtered states; those constant for the mission with their final estimates, which use most data.
  [[nodiscard]] BatchStates filtered();
  /// Linearises everything at the states: normal() d = right(), with d the errors of the states.
  /// @return  cost
  double linearise(const BatchStates& states);
  /// Subtracts errors from the states.
  void remove(const Eigen::VectorXd& d, BatchStates& states);
  /// Covariance of the navigation states at a knot, and of all states there.
  [[nodiscard]] Eigen::MatrixXd nav_covariance(std::size_t knot, const SelectedInverse& inverse);
  [[nodiscard]] Eigen::MatrixXd covariance(std::size_t knot, const SelectedInverse& inverse);

  [[nodiscard]] const LowerTriangle& normal() const { return normal_.lower(); }
  void forget_normal() { normal_.clear(); }
  [[nodiscard]] const std::vector<int>& unknown_once() const { return unknowns_.unknown_once(); }
  [[nodiscard]] const Eigen::VectorXd& right() const { return right_; }
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

 private:
  void add_prior(const BatchStates& states);
  void add_measurements(std::size_t knot, const BatchStates& states, const SampleCursor& cursor, const Navigator& navigator);
  void add_transition(std::size_t knot, const BatchStates& states, const Propagation& arrived, const Eigen::MatrixXd& Q);
  /// Equations J d = target of the errors of all states at a knot, whitened.
  void add_equations(std::size_t knot, const Eigen::MatrixXd& J, const Eigen::VectorXd& target);
  /// Rows of the transition of states that are unknowns at every knot.
  [[nodiscard]] const Eigen::MatrixXd& transition_rows(const Propagation& arrived);
  [[nodiscard]] const Eigen::MatrixXd& of_mission(std::size_t knot) { return unknowns_.of_mission(elapsed(knot)); }
  /// Errors of all states at a knot.
  [[nodiscard]] Eigen::VectorXd errors_at(std::size_t knot, const Eigen::VectorXd& d);
  [[nodiscard]] double elapsed(std::size_t knot) const { return knots_.time(knot) - knots_.time(0); }
  [[nodiscard]] Eigen::Index first_of(std::size_t knot) const { return normal_.first_of(static_cast<Eigen::Index>(knot)); }
  [[nodiscard]] bool is_in(const KnotMeasurement& m) const;

  const Mission& mission_;
  const StateLayout& layout_;
  const FilterOptions& options_;
  const FilterState& start_;
  const KnotStore& knots_;
  const std::vector<KnotMeasurement>& measurements_;
  RobustLoss loss_;
  BatchUnknowns unknowns_;
  BlockTransitions blocks_;
  ChainMatrix normal_;
  Eigen::VectorXd right_;
  std::vector<double> weights_;
  std::size_t next_measurement_ = 0;
  double cost_ = 0.0;
  // Members to reuse their memory.
  Eigen::MatrixXd Phi_, W_, G_;
  FilterState at_knot_;
};

}  // namespace coast::estimate
