#pragma once
// Measurement at a knot, in a form that can be linearised at another state; private to the room.

#include <optional>

#include "coast/estimate/forward_filter.hpp"

namespace coast::estimate {

/// The measurement at the state. @return  none if it does not apply
[[nodiscard]] std::optional<Linearised> linearise(const Measurement& measurement, const Mission& mission,
                                                  const FilterOptions& options, const FilterState& state,
                                                  const UpdateContext& context);

}  // namespace coast::estimate
