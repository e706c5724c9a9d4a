#pragma once
// A rover's and a base's observations in place of fixes: what a tightly coupled filter takes.

#include <memory>
#include <vector>

#include "coast/carrier/ppk.hpp"

namespace coast::estimate {

struct CarrierObservations {
  struct Epoch {
    geo::GpsTime t;  ///< in the filter's time, the receiver's clock error taken off
    const carrier::DifferenceEpoch* differences = nullptr;
  };
  std::vector<Epoch> epochs;                                                 ///< in order of the filter's time
  std::shared_ptr<const std::vector<carrier::DifferenceEpoch>> differences;  ///< what the epochs point to
  carrier::PpkOptions options;                                               ///< with `air` and `noise` settled
  double interval_s = 0.0;                                                   ///< of the rover
  std::size_t most_unknowns = 0;                                             ///< beside position and velocity, at a time
};

/// Every epoch of a solution. Where too few satellites tell the receiver's clock it is interpolated.
/// @param options  of the solution; what it settled is taken from it
[[nodiscard]] CarrierObservations carrier_observations(carrier::PpkSolution solution, const carrier::PpkOptions& options);
/// The same to a clock that runs backwards from `mirror`.
[[nodiscard]] CarrierObservations reversed(CarrierObservations observations, geo::GpsTime mirror);

}  // namespace coast::estimate
