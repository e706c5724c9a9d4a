#pragma once
// Differences between receivers for a filter that knows from elsewhere where the rover is: tight coupling.

#include <memory>

#include "coast/carrier/ppk.hpp"
#include "coast/carrier/relative_state.hpp"

namespace coast::carrier {

/// What an epoch tells such a filter.
struct CoupledEpoch {
  bool usable = false;
  Shortfall shortfall = Shortfall::kNone;
  /// What becomes of the unknowns other than position and velocity, in order, before the measurements.
  std::vector<StateChange> changes;
  std::vector<Unknown> unknowns;  ///< after the changes: the columns of H and H_integers; the first three are the position
  /// Double differences of phases, codes and rates, of unit variance and uncorrelated: nu = H (truth - state) + noise.
  Eigen::MatrixXd H;
  Eigen::VectorXd nu;
  double nis = 0.0;
  /// Integers that have come out several epochs in a row, as measurements like the others, of the state behind these.
  Eigen::MatrixXd H_integers;
  Eigen::VectorXd nu_integers;
  int satellites = 0;
  double ratio = 0.0;
  bool fixed = false;
};

/// Settles what RelativeFilter settles for a rover by itself: which ambiguities begin, go on and end, what is left out, and
/// what is an integer. The filter that it serves carries the unknowns.
class Coupling {
 public:
  /// @param options  with `air` and `noise` settled; must outlive this  @param interval_s  of the rover
  Coupling(const PpkOptions& options, double interval_s);
  ~Coupling();
  Coupling(Coupling&&) noexcept;
  Coupling& operator=(Coupling&&) noexcept;

  /// Epochs in order of time, or all of them against it.
  /// @param prior  position, velocity (kVelocityUnknowns) and whatever unknowns are carried, with their covariance
  [[nodiscard]] CoupledEpoch step(RelativeState prior, const DifferenceEpoch& epoch);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Most unknowns, position and velocity apart, that such a filter carries at a time.
[[nodiscard]] std::size_t most_unknowns(const std::vector<DifferenceEpoch>& epochs, const PpkOptions& options,
                                        double interval_s);

}  // namespace coast::carrier
