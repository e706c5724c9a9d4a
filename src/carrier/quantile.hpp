#pragma once
// Order statistics. Private to the room.

#include <algorithm>
#include <cmath>
#include <vector>

namespace coast::carrier {

/// The value not exceeded by a given fraction. @param values  at least one
inline double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

inline double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace coast::carrier
