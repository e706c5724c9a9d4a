#include "resolution.hpp"

#include <algorithm>
#include <cmath>

namespace coast::noise {

namespace {

// The smallest distance between values that differ by more than the rounding of their conversion.
double step_of(std::vector<double> values) {
  constexpr double kSame = 1e-6;  // of the range
  constexpr double kMost = 0.1;   // share of different values: with more the record shows no lattice
  std::ranges::sort(values);
  const double same = kSame * (values.back() - values.front());
  double least = 0.0;
  std::size_t different = 1;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double distance = values[i] - values[i - 1];
    if (!(distance > same)) continue;
    ++different;
    least = least > 0.0 ? std::min(least, distance) : distance;
  }
  return static_cast<double>(different) < kMost * static_cast<double>(values.size()) ? least : 0.0;
}

}  // namespace

double white_scatter(const StaticSignal& signal) {
  double squares = 0.0;
  std::size_t count = 0;
  for (const StaticSignal::Run& run : signal.runs)
    for (std::size_t i = run.first + 1; i < run.first + run.count; ++i, ++count)
      squares += (signal.values[i] - signal.values[i - 1]) * (signal.values[i] - signal.values[i - 1]);
  return count > 0 ? std::sqrt(0.5 * squares / static_cast<double>(count)) : 0.0;
}

Resolution resolution_of(const StaticSignal& signal) {
  if (signal.values.empty()) return {};
  return {step_of(signal.values), white_scatter(signal)};
}

}  // namespace coast::noise
