#pragma once
// The backward recursion over knots; private to the room.

#include "coast/estimate/future.hpp"
#include "coast/estimate/smoother.hpp"

namespace coast::estimate {

/// r and N of docs/notation.md, propagated from knot to knot towards the start.
class BackwardRecursion {
 public:
  enum class Carries { kBoth, kVector };  ///< r and N, or only r, which does not need N
  explicit BackwardRecursion(const StateLayout& layout, Carries carries = Carries::kBoth);
  /// Begins after a knot's updates, with the information from after the end of this recording.
  void begin(const Knot& knot, const Future& behind);
  /// From the next knot back to this one, over its interval.
  void through_transition(const Knot& knot);
  /// A knot's updates, the last one first, and the changes of the carrier slots before them.
  void through_updates(const Knot& knot);
  /// One of them.
  void through_update(const AppliedUpdate& update);
  /// These are valid after the knot's updates.
  [[nodiscard]] SmoothedKnot smoothed(const Knot& knot, bool with_states) const;
  /// Only the state, for which r suffices.
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
