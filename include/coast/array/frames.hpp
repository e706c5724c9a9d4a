#pragma once
// Transformation from each sensor's position and axes to one point and one frame: Stebler et al. (2011), Eqs. (4) and (5).

#include <Eigen/Core>
#include <vector>

#include "coast/array/signals.hpp"

namespace coast::array {

/// Position and axes of an IMU on the platform.
struct SensorFrame {
  Eigen::Matrix3d C_s_b = Eigen::Matrix3d::Identity();  ///< sensor to body axes
  Eigen::Vector3d r_b = Eigen::Vector3d::Zero();        ///< body's origin to the IMU's measurement point, m, body axes
};

/// Differentiates signals on a regular grid: at each sample the slope of the fourth-degree polynomial fitted to 2 m + 1 samples
/// (Savitzky & Golay 1964); within m samples of an end, the first or last such fit is evaluated off its middle.
///
/// Its error has two parts. White noise of standard deviation sigma per sample becomes `noise_gain()` sigma. Motion at
/// frequency f is attenuated by `response(f)`; for slow motion 1 - response is of fourth order in f m dt.
class Differentiator {
 public:
  /// @param half_width m, >= 2  @param dt s, > 0  @throws std::invalid_argument
  Differentiator(int half_width, double dt);

  [[nodiscard]] int half_width() const { return half_width_; }
  /// Standard deviation of the derivative for white noise of standard deviation 1, 1/s.
  [[nodiscard]] double noise_gain() const;
  /// Computed over true derivative of a sine of frequency f [Hz], 1 for slow motion.
  [[nodiscard]] double response(double frequency) const;
  /// Coefficients of the 2 m + 1 samples about the one at which the slope is computed, 1/s.
  [[nodiscard]] Eigen::RowVectorXd coefficients() const { return slope_at_.row(half_width_); }
  /// @param x 3 x N, N > 2 m  @return 3 x N, per second  @throws std::invalid_argument  too few samples
  [[nodiscard]] Eigen::Matrix3Xd apply(const Eigen::Ref<const Eigen::Matrix3Xd>& x) const;

 private:
  int half_width_;
  double dt_;
  Eigen::MatrixXd slope_at_;  ///< row i: coefficients for the slope at sample i of a window, 1/s
};

/// Motion of the platform, and the chosen differentiator.
struct AngularMotion {
  Eigen::Matrix3Xd omega;  ///< rad/s, mean of all sensors over each interval
  Eigen::Matrix3Xd alpha;  ///< rad/s^2, likewise
  int half_width = 0;
  double noise_sd = 0.0;  ///< rad/s, of a sample of omega, root mean square over the axes
  double error_sd = 0.0;  ///< rad/s^2, error of alpha estimated from the rates: noise and attenuated motion
};

/// Angular rate and acceleration of the platform from all its rates. The differentiator with the smallest mean square error is
/// chosen, half widths 2 to 44: its noise follows from the differences of the sensors, the attenuated motion from its
/// difference to the next narrower one beyond the noise of both.
/// @param signals  rates in body axes; at least 2 m + 1 = 5 columns
/// @throws std::invalid_argument  no sensors, or too few columns
[[nodiscard]] AngularMotion angular_motion(const Signals& signals);

/// Rotates rates and specific forces to body axes, still at each sensor's position.
void turn_to_body(Signals& signals, const std::vector<SensorFrame>& frames);

/// Specific force at r_b minus that at the origin, mean over an interval, in body axes:
///     alpha x r + omega x (omega x r) + dt^2 / 12 alpha x (alpha x r)
/// The last term is the mean of the centripetal one over an interval in which omega changes; Eq. (5) as printed in the paper
/// adds vectors of two frames, which is correct only if these are parallel.
[[nodiscard]] Eigen::Vector3d size_effect(const Eigen::Vector3d& omega, const Eigen::Vector3d& alpha,
                                          const Eigen::Vector3d& r_b, double dt);

/// Transfers specific forces from each sensor's position to the body's origin. Rates and forces must already be in body axes.
void move_to_origin(Signals& signals, const std::vector<SensorFrame>& frames, const AngularMotion& motion);

}  // namespace coast::array
