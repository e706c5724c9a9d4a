#pragma once
// A filtered mission as the linear least-squares problem that its smoother solves: the filter's own linearisation, written out.

#include <vector>

#include "coast/estimate/batch_smoother.hpp"
#include "estimate/mission.hpp"

namespace coast::test {

/// Rows J u = target with noise of covariance I. Unknowns u: of every knot those states that have driving noise, one knot after
/// the other; then those that have none, once, as they are at the start. Their error at a knot is map(k) u + offset(k).
class LinearProblem {
 public:
  /// Filters the mission; GNSS alone, none of it gated.
  LinearProblem(const estimate::Mission& mission, const estimate::ForwardFilter& filter, const estimate::FilterState& start);

  [[nodiscard]] const Eigen::MatrixXd& J() const { return J_; }
  [[nodiscard]] const Eigen::VectorXd& target() const { return target_; }
  [[nodiscard]] const estimate::KnotStore& knots() const { return knots_; }
  [[nodiscard]] Eigen::Index links() const { return static_cast<Eigen::Index>(knots_.size()); }
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(at_knots_.size()); }
  [[nodiscard]] Eigen::Index border() const { return static_cast<Eigen::Index>(once_.size()); }

  /// Errors of all states behind the knot's updates: n x (size + border), of the knot's unknowns and those of the mission.
  [[nodiscard]] Eigen::MatrixXd map(Eigen::Index knot) const;
  /// Columns of J that map() is about.
  [[nodiscard]] std::vector<Eigen::Index> columns(Eigen::Index knot) const;
  /// What the filter's corrections have made of states without driving noise.
  [[nodiscard]] Eigen::VectorXd offset(Eigen::Index knot) const;

 private:
  struct Rows {
    Eigen::Index knot;  ///< of the first columns; those of the next follow
    Eigen::MatrixXd of_knot, of_next;
    Eigen::VectorXd target;
  };
  void filter_forward(const estimate::ForwardFilter& filter);
  void add_prior();
  void add_updates(const estimate::Mission& mission, Eigen::Index knot);
  void add_transition(const estimate::ForwardFilter& filter, Eigen::Index knot);
  /// Equations of the errors of all states behind the knot's updates, and of the next one's.
  void add(Eigen::Index knot, const Eigen::MatrixXd& of_knot, const Eigen::MatrixXd& of_next, const Eigen::VectorXd& target,
           const Eigen::MatrixXd& covariance);
  void gather();
  [[nodiscard]] Eigen::MatrixXd moved(Eigen::MatrixXd of_states, double elapsed) const;
  [[nodiscard]] double elapsed(Eigen::Index knot) const;

  const estimate::StateLayout& layout_;
  estimate::FilterState start_;
  estimate::KnotStore knots_;
  std::vector<estimate::FilterState> predicted_;     ///< at every knot, before its updates
  std::vector<estimate::KnotMeasurement> measured_;  ///< in the order of the updates
  std::vector<int> at_knots_, once_;
  std::vector<Rows> rows_;
  Eigen::MatrixXd J_;
  Eigen::VectorXd target_;
  std::size_t next_measured_ = 0;
};

}  // namespace coast::test
