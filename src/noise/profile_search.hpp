#pragma once
// Limits of a 95 % interval from the profile likelihood. Private to the room.

#include <functional>
#include <optional>

namespace coast::noise {

inline constexpr double kProfileRoot95 = 1.959963984540054;  ///< square root of the 95 % quantile of chi2(1)

/// The distance at which the root is 1.96, kept between distances known to be too small and too large.
/// @param root_at  sqrt(2 (max - profile)) at a distance from the maximum
/// @param guess    of the distance
/// @return none if the root is below 1.96 at `farthest`
[[nodiscard]] std::optional<double> crossing(const std::function<double(double)>& root_at, double guess, double farthest);

}  // namespace coast::noise
