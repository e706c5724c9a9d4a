#pragma once
// Integers that are known from other epochs than the one in hand. Private to the room.

#include <map>
#include <vector>

#include "coast/carrier/differences.hpp"
#include "coast/carrier/relative_state.hpp"

namespace coast::carrier {

/// An ambiguity minus that of its reference equals this integer.
struct FixedPair {
  Unknown ambiguity, reference;
  double integer = 0.0;
};

/// Pairs as measurements of unit variance: v = H (truth - state) + noise.
struct HeldIntegers {
  Eigen::MatrixXd H;
  Eigen::VectorXd nu;
};
HeldIntegers held(const std::vector<FixedPair>& pairs, const RelativeState& state);

/// Fix and hold: integers fixed often enough to be used as measurements.
class IntegerHold {
 public:
  /// To be called for every fixed epoch. @return the pairs that were the same for some consecutive epochs
  std::vector<FixedPair> agreed(const std::vector<FixedPair>& fixed);

 private:
  struct Candidate {
    double value = 0.0;  ///< cycles, relative to the reference of its group
    int epochs = 0;      ///< consecutive
  };
  std::map<Unknown, Candidate> candidates_;
};

/// What one pass found out about the ambiguities, epoch by epoch.
struct AmbiguityHistory {
  std::vector<std::vector<FixedPair>> fixed;    ///< integers
  std::vector<std::vector<Unknown>> restarted;  ///< contradicted by the phase of this epoch
};

/// Begins a new arc wherever either pass restarted an ambiguity, in the epochs and in both histories: forward in time the slip
/// is before the epoch of the restart, backward after it.
void split_arcs(std::vector<DifferenceEpoch>& epochs, AmbiguityHistory& forward, AmbiguityHistory& backward);

/// Integers of whole arcs, by majority of the epochs of both passes in which they were fixed. A mission is solved after it has
/// ended, so the integers of an arc are known at its first epoch too.
class KnownIntegers {
 public:
  KnownIntegers() = default;
  KnownIntegers(const AmbiguityHistory& forward, const AmbiguityHistory& backward);
  /// Those of an epoch's phases, each relative to another one of the epoch.
  [[nodiscard]] std::vector<FixedPair> of(const DifferenceEpoch& epoch) const;
  [[nodiscard]] bool empty() const { return places_.empty(); }

 private:
  struct Place {
    int component = 0;     ///< arcs whose differences are known
    double integer = 0.0;  ///< relative to one arc of the component
  };
  std::map<Unknown, Place> places_;
};

}  // namespace coast::carrier
