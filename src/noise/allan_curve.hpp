#pragma once
// Curve points from sums, and the slope of a curve: shared by the estimator and the reading of coefficients.

#include <span>

#include "allan_differences.hpp"
#include "coast/noise/allan.hpp"

namespace coast::noise {

/// @param full_overlap  a term starts at every sample, else at every block of the factor's level
[[nodiscard]] AllanCurve make_curve(double interval, std::span<const AveragingFactor> factors,
                                    std::span<const DifferenceSums> sums, bool full_overlap);

/// d log sigma / d log tau by least squares over the points within an octave to both sides; none if there is no other point.
[[nodiscard]] std::optional<double> local_slope(const AllanCurve& curve, std::size_t at);

}  // namespace coast::noise
