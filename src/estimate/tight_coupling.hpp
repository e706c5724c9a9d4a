#pragma once
// Carrier-phase observations of an epoch as updates of the navigation filter; private to the room.

#include "coast/carrier/coupling.hpp"
#include "coast/estimate/forward_filter.hpp"

namespace coast::estimate {

/// Assigns each unknown of the observations a slot among the filter's states while it exists. The output of carrier::Coupling
/// for an epoch is applied as updates of three rows at a time; their noise is uncorrelated, so the order does not matter.
class TightCoupling {
 public:
  /// @param layout  including slots
  TightCoupling(const CarrierObservations& observations, const StateLayout& layout, bool time_reversed);

  /// Clears all slots.
  void begin(FilterState& state);
  /// Continues from a knot.
  void begin(const Knot& knot) { slots_ = knot.slots; }

  struct Outcome {
    bool contradicted = false;  ///< the observations contradict the filter or each other: nothing was changed
    std::optional<InnovationRecord> innovation;
    double log_likelihood = 0.0;
  };
  /// Updates the state and adds to the knot what the smoother needs.
  [[nodiscard]] Outcome update(const carrier::DifferenceEpoch& epoch, const UpdateContext& context, FilterState& state,
                               Knot& knot);

 private:
  [[nodiscard]] carrier::RelativeState prior(const UpdateContext& context, const FilterState& state) const;
  void follow(const std::vector<carrier::StateChange>& changes, FilterState& state, Knot& knot);
  [[nodiscard]] Eigen::Index slot_of(const carrier::Unknown& unknown) const;
  [[nodiscard]] Eigen::MatrixXd over_states(const Eigen::MatrixXd& H, const std::vector<carrier::Unknown>& unknowns,
                                            const UpdateContext& context, const FilterState& state) const;

  const StateLayout& layout_;
  carrier::Coupling coupling_;
  double direction_;                     ///< of time: -1 for velocities of a time-reversed recording
  std::vector<carrier::Unknown> slots_;  ///< kPosition marks a free one
};

}  // namespace coast::estimate
