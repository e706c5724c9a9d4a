#pragma once
// Tight coupling: differences between receivers for a filter that has a prior position of the rover.

#include <memory>

#include "coast/carrier/ppk.hpp"
#include "coast/carrier/relative_state.hpp"

namespace coast::carrier {

/// Measurements of one epoch for the filter.
struct CoupledEpoch {
  bool usable = false;
  Shortfall shortfall = Shortfall::kNone;
  /// Changes of the unknowns other than position and velocity, in order, before the measurements.
  std::vector<StateChange> changes;
  std::vector<Unknown> unknowns;  ///< after the changes: the columns of H and H_integers; the first three are the position
  /// Double differences of phases, codes and rates, decorrelated to unit variance: nu = H (truth - state) + noise.
  Eigen::MatrixXd H;
  Eigen::VectorXd nu;
  double nis = 0.0;
  /// Integers that were the same for several epochs in a row, as further measurements, relative to the state after those above.
  Eigen::MatrixXd H_integers;
  Eigen::VectorXd nu_integers;
  int satellites = 0;
  double ratio = 0.0;
  bool fixed = false;
};

/// Makes the decisions that RelativeFilter makes for a rover alone: which ambiguities begin, continue and end, which
/// observations are rejected, and which ambiguities are integers. The unknowns are states of the filter that uses it.
class Coupling {
 public:
  /// @param options  with `air` and `noise` set; must outlive this  @param interval_s  of the rover
  Coupling(const PpkOptions& options, double interval_s);
  ~Coupling();
  Coupling(Coupling&&) noexcept;
  Coupling& operator=(Coupling&&) noexcept;

  /// Epochs in time order, or all in reverse time order.
  /// @param prior  position, velocity (kVelocityUnknowns) and all current unknowns, with their covariance
  [[nodiscard]] CoupledEpoch step(RelativeState prior, const DifferenceEpoch& epoch);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Largest number of unknowns, without position and velocity, that such a filter has at one time.
[[nodiscard]] std::size_t most_unknowns(const std::vector<DifferenceEpoch>& epochs, const PpkOptions& options,
                                        double interval_s);

}  // namespace coast::carrier
