#pragma once
// Observations of rover and base instead of fixes: the input of a tightly coupled filter.

#include <memory>
#include <vector>

#include "coast/carrier/ppk.hpp"

namespace coast::estimate {

struct CarrierObservations {
  struct Epoch {
    geo::GpsTime t;  ///< in the filter's time, corrected for the receiver clock error
    const carrier::DifferenceEpoch* differences = nullptr;
  };
  std::vector<Epoch> epochs;                                                 ///< in order of the filter's time
  std::shared_ptr<const std::vector<carrier::DifferenceEpoch>> differences;  ///< what the epochs point to
  carrier::PpkOptions options;                                               ///< with `air` and `noise` set
  double interval_s = 0.0;                                                   ///< of the rover
  std::size_t most_unknowns = 0;  ///< largest number at one time, besides position and velocity
};

/// Every epoch of a solution. The receiver clock error is interpolated where too few satellites determine it.
/// @param options  of the solution; `air` and `noise` come from the solution itself
[[nodiscard]] CarrierObservations carrier_observations(carrier::PpkSolution solution, const carrier::PpkOptions& options);
/// The same in reversed time, mirrored at `mirror`.
[[nodiscard]] CarrierObservations reversed(CarrierObservations observations, geo::GpsTime mirror);

}  // namespace coast::estimate
