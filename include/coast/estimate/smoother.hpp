#pragma once
// The backward pass over the knots, and the smoothed trajectory at IMU epochs.

#include <functional>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/future.hpp"
#include "coast/estimate/knot.hpp"

namespace coast::estimate {

/// Smoothed state at a knot.
struct SmoothedKnot {
  record::NavState nav;
  record::NavCovariance cov;
  Eigen::VectorXd x;   ///< size of the layout, navigation part zero; empty if not sampled
  Eigen::VectorXd sd;  ///< of the errors of x (and, in e, of the navigation states); empty if not sampled
  bool jumps = false;  ///< not the same solution as at the previous knot (combine()): no interpolation between the two
};

/// Fixed-interval smoothing by the backward recursion of Bryson & Frazier (1963) / de Jong (1989):
///
///     through an update:      r <- H' S^-1 y + (I - K H)' r,     N <- H' S^-1 H + (I - K H)' N (I - K H)
///     through a transition:   r <- Phi' r,                       N <- Phi' N Phi
///     smoothed error of the filtered state:  d = P r,  covariance P - P N P
///
/// Equal to the Rauch-Tung-Striebel smoother, but only matrices of the size of a measurement are inverted; r and N are also the
/// statistics for shocks and for the noise (docs/notation.md).
/// @param states  knots for which x and sd are stored: for a long mission, storing all would use most of the memory
/// @param behind  information from after the last knot (futures() of another run at the same instant); null: none
[[nodiscard]] std::vector<SmoothedKnot> smooth(const KnotStore& knots, const StateLayout& layout,
                                               const std::function<void(double)>& progress = {},
                                               const KnotSampling& states = KnotSampling{}, const Future* behind = nullptr);

/// Smoothed state of the first knot only, without covariances: r without N, in a tenth of the time of smooth().
[[nodiscard]] SmoothedKnot smooth_first(const KnotStore& knots, const StateLayout& layout);

/// Smoothed epochs at IMU times: the nominal trajectory is recomputed from knot to knot and its smoothed error interpolated
/// (position and velocity by the cubic through the errors and error rates at both ends, attitude linearly), so that nothing is
/// stored at IMU rate. Before a knot that jumps, the error of the previous knot is kept constant. Computed on all threads,
/// delivered in order: the sink and `progress` are called one at a time, though not always from the same thread. Bitwise the
/// same for any number of threads.
void emit_smoothed(const Mission& mission, const StateLayout& layout, const KnotStore& knots,
                   const std::vector<SmoothedKnot>& smoothed, const record::EpochSink& sink,
                   const std::function<void(double)>& progress = {});

}  // namespace coast::estimate
