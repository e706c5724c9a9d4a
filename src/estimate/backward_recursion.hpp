#pragma once
// The backward recursion over knots; private to the room.

#include "coast/estimate/future.hpp"
#include "coast/estimate/smoother.hpp"

namespace coast::estimate {

/// r and N of docs/notation.md, taken from knot to knot towards the start.
class BackwardRecursion {
 public:
  enum class Carries { kBoth, kVector };  ///< r and N, or r alone, which needs no N
  explicit BackwardRecursion(const StateLayout& layout, Carries carries = Carries::kBoth);
  /// Begins behind a knot's updates with what lies beyond the recording at hand.
  void begin(const Knot& knot, const Future& behind);
  /// Between a knot and the next one, its interval.
  void through_transition(const Knot& knot);
  /// A knot's updates, the last one first, and what happened to the carrier slots before them.
  void through_updates(const Knot& knot);
  /// One of them.
  void through_update(const AppliedUpdate& update);
  /// These hold behind the knot's updates.
  [[nodiscard]] SmoothedKnot smoothed(const Knot& knot, bool with_states) const;
  /// The state alone, which r is enough for.
  [[nodiscard]] SmoothedKnot smoothed_state(const Knot& knot) const;
  [[nodiscard]] Future future(const Knot& knot) const;
  [[nodiscard]] const Eigen::VectorXd& r() const { return r_; }
  [[nodiscard]] const Eigen::MatrixXd& N() const { return N_; }

 private:
  void through_slot_changes(const Eigen::VectorXd& factors);
  void times_phi(const Knot& knot);

  const StateLayout& layout_;
  Carries carries_;
  BlockTransitions blocks_;
  Eigen::VectorXd r_;
  Eigen::MatrixXd N_;
};

}  // namespace coast::estimate
