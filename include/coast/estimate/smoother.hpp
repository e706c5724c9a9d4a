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
  Eigen::VectorXd x;   ///< size of the layout, navigation part zero; empty where not sampled
  Eigen::VectorXd sd;  ///< of the errors of x (and, in e, of the navigation states); empty where not sampled
  bool jumps = false;  ///< not the same solution as at the knot before (combine()): nothing lies between the two
};

/// Fixed-interval smoothing by the backward recursion of Bryson & Frazier (1963) / de Jong (1989):
///
///     through an update:      r <- H' S^-1 y + (I - K H)' r,     N <- H' S^-1 H + (I - K H)' N (I - K H)
///     through a transition:   r <- Phi' r,                       N <- Phi' N Phi
///     smoothed error of the filtered state:  d = P r,  covariance P - P N P
///
/// Equal to the Rauch-Tung-Striebel smoother, inverts nothing larger than a measurement; r and N are at the same time the
/// statistics for shocks and for the noise (docs/notation.md).
/// @param states  knots that keep x and sd: of a long mission all of them would be most of its memory
/// @param behind  what is known from beyond the last knot (futures() of another run at the same instant); null: nothing
[[nodiscard]] std::vector<SmoothedKnot> smooth(const KnotStore& knots, const StateLayout& layout,
                                               const std::function<void(double)>& progress = {},
                                               const KnotSampling& states = KnotSampling{}, const Future* behind = nullptr);

/// The state of the first knot as smooth() has it, alone and without covariances: r without N, a tenth of the time.
[[nodiscard]] SmoothedKnot smooth_first(const KnotStore& knots, const StateLayout& layout);

/// Smoothed epochs at the IMU's: the nominal trajectory is repeated from knot to knot and its smoothed error interpolated
/// (position and velocity by the cubic through both ends' errors and their rates, attitude linearly), so that nothing at IMU
/// rate is ever stored. Before a knot that jumps the error of the knot before it is kept. Computed on all threads, delivered in
/// order: the sink and `progress` are called one at a time, though not always from the same thread. The same bytes for any
/// number of threads.
void emit_smoothed(const Mission& mission, const StateLayout& layout, const KnotStore& knots,
                   const std::vector<SmoothedKnot>& smoothed, const record::EpochSink& sink,
                   const std::function<void(double)>& progress = {});

}  // namespace coast::estimate
