#pragma once
// Biases that drift more than the error model of an IMU allows: a data sheet states the instability of a sensor at rest at
// constant temperature, not under vibration and changing temperature.

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "coast/estimate/smoother.hpp"
#include "coast/estimate/state_layout.hpp"

namespace coast::study {

/// Factors on the stationary sigma of the Gauss-Markov biases of each axis, x, y, z of the sensor.
struct DriftFactors {
  Eigen::Vector3d gyro = Eigen::Vector3d::Ones();
  Eigen::Vector3d accel = Eigen::Vector3d::Ones();
  [[nodiscard]] double largest() const { return std::max(gyro.maxCoeff(), accel.maxCoeff()); }
};

/// One step of the EM algorithm for the stationary variance (Shumway & Stoffer 1982): the mean of x^2 + var x over the knots,
/// relative to the model's variance, as a factor on sigma; 1 if it is not above `least`, and for an axis without such a
/// process.
[[nodiscard]] DriftFactors drift_seen(const estimate::StateLayout& layout, const std::vector<estimate::SmoothedKnot>& knots,
                                      double least);

[[nodiscard]] noise::ImuErrorModel with_drift_scaled(const noise::ImuErrorModel& model, double rate_hz,
                                                     const DriftFactors& factors);

}  // namespace coast::study
