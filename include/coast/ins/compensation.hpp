#pragma once
// Coning and sculling to high order: rotation and velocity increment of each IMU interval, with rate and force interpolated
// through the surrounding increments. For vibration, gait and skiing, where the linear model of the two-sample form is too
// coarse; in post-processing later samples are available.

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "coast/ins/strapdown.hpp"
#include "coast/record/imu.hpp"

namespace coast::ins {

/// Increments in a window of `compensate_chebyshev`: rate and force are polynomials of degree 10 that match their integrals.
inline constexpr std::size_t kCompensationWindow = 11;

/// Exact rotation and velocity increment of one interval of a window of equal intervals.
///
/// The integrals of rate and specific force over the window are interpolated at its 12 interval ends. On the requested
/// interval, the Rodrigues vector g = 2 tan(|phi|/2) phi/|phi| is found by functional iteration on polynomials represented at
/// Chebyshev points,
///
///     g(t) = integral of ( omega + [g x omega]/2 + (g . omega) g / 4 ),    u = integral of C(g) f,
///
/// where the integral of omega (of f) itself is the unchanged increment.
/// @param window    `kCompensationWindow` increments, equal dt > 0 (not checked beyond the count), |dtheta| well below 1 rad
/// @param position  index of the interval in the window; the middle is best, the ends have neighbours on one side only
/// @throws std::invalid_argument  wrong count, position outside the window
/// @note  Coning of frequency f sampled at F: relative error of the coning correction (2.85 f/F)^10 in the middle of the window
///        (1e-12 at f/F = 0.02, 4e-9 at 0.05, 4e-6 at 0.1); two-sample: 8 (f/F)^2.
/// @see   Wu (2018), RodFIter: Attitude Reconstruction from Inertial Measurements by Functional Iteration, IEEE Trans. AES 54;
///        Wu, Cai, Truong (2018), Fast RodFIter. They process a block of samples at once; here a sliding window.
[[nodiscard]] BodyIncrement compensate_chebyshev(std::span<const RawIncrement> window, std::size_t position);

/// Replaces (dtheta, dv) of every sample by (phi, u) of its `BodyIncrement`, in place; extra memory is one window. Adjoining
/// intervals that are equal to 0.1 % and 2 us form a run; runs shorter than a window, and intervals that follow a gap or differ
/// in length, use the two-sample form, or one sample (constant motion) after missing time.
/// @param body  raw increments in any axes, strictly increasing in time
void compensate_chebyshev(record::ImuRecording& body);

/// Removes constant sensor biases from an increment that was compensated with the biases included: equal to compensating the
/// corrected raw increments, to second order in small angles and first in the biases.
/// @param gyro_bias   rad/s   @param accel_bias  m/s^2, both measured minus true
[[nodiscard]] BodyIncrement without_bias(const BodyIncrement& increment, const Eigen::Vector3d& gyro_bias,
                                         const Eigen::Vector3d& accel_bias);

}  // namespace coast::ins
