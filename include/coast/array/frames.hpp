#pragma once
// From each sensor's place and axes to one point and one frame: Stebler et al. (2011), Eqs. (4) and (5).

#include <Eigen/Core>
#include <vector>

#include "coast/array/signals.hpp"

namespace coast::array {

/// Where an IMU sits on the platform.
struct SensorFrame {
  Eigen::Matrix3d C_s_b = Eigen::Matrix3d::Identity();  ///< sensor to body axes
  Eigen::Vector3d r_b = Eigen::Vector3d::Zero();        ///< body's origin to the IMU's measurement point, m, body axes
};

/// Differentiates signals on a regular grid: at each sample the slope of the polynomial of fourth degree that fits 2 m + 1
/// samples best (Savitzky & Golay 1964); nearer to an end than m samples the same fit is read off the middle.
///
/// Its error has two parts. White noise of standard deviation sigma per sample becomes `noise_gain()` sigma. Motion of the
/// frequency f loses what `response(f)` falls short of 1; for slow motion that is of fourth order in f m dt.
class Differentiator {
 public:
  /// @param half_width m, >= 2  @param dt s, > 0  @throws std::invalid_argument
  Differentiator(int half_width, double dt);

  [[nodiscard]] int half_width() const { return half_width_; }
  /// Standard deviation of the derivative for white noise of standard deviation 1, 1/s.
  [[nodiscard]] double noise_gain() const;
  /// Derivative found of a sine of frequency f [Hz] as a share of the true one, 1 for slow motion.
  [[nodiscard]] double response(double frequency) const;
  /// Of the 2 m + 1 samples about the one where the slope is asked for, 1/s.
  [[nodiscard]] Eigen::RowVectorXd coefficients() const { return slope_at_.row(half_width_); }
  /// @param x 3 x N, N > 2 m  @return 3 x N, per second  @throws std::invalid_argument  too few samples
  [[nodiscard]] Eigen::Matrix3Xd apply(const Eigen::Ref<const Eigen::Matrix3Xd>& x) const;

 private:
  int half_width_;
  double dt_;
  Eigen::MatrixXd slope_at_;  ///< row i: coefficients for the slope at sample i of a window, 1/s
};

/// What a differentiator was chosen for.
struct AngularMotion {
  Eigen::Matrix3Xd omega;  ///< rad/s, mean of all sensors over each interval
  Eigen::Matrix3Xd alpha;  ///< rad/s^2, likewise
  int half_width = 0;
  double noise_sd = 0.0;  ///< rad/s, of a sample of omega, root mean square over the axes
  double error_sd = 0.0;  ///< rad/s^2, what alpha is wrong by as far as its own rates tell: noise and lost motion
};

/// Angular rate and acceleration of the platform from all its rates. Of differentiators from 2 to 44 samples to either side
/// that with the least mean square error is taken: its noise is known from how the sensors differ, the motion that it loses is
/// what it differs from the next narrower one by beyond the noise of both.
/// @param signals  rates in body axes; at least 2 m + 1 = 5 columns
/// @throws std::invalid_argument  no sensors, or too few columns
[[nodiscard]] AngularMotion angular_motion(const Signals& signals);

/// Rates and specific forces turned into body axes, where each sensor is.
void turn_to_body(Signals& signals, const std::vector<SensorFrame>& frames);

/// What a specific force at r_b feels beyond one at the origin, mean over an interval, in body axes:
///     alpha x r + omega x (omega x r) + dt^2 / 12 alpha x (alpha x r)
/// The last term is the mean of the centripetal one over an interval in which omega changes; the paper's Eq. (5) as printed
/// adds vectors of two frames unless these are parallel.
[[nodiscard]] Eigen::Vector3d size_effect(const Eigen::Vector3d& omega, const Eigen::Vector3d& alpha,
                                          const Eigen::Vector3d& r_b, double dt);

/// Specific forces brought from where each sensor is to the body's origin. Rates and forces are in body axes already.
void move_to_origin(Signals& signals, const std::vector<SensorFrame>& frames, const AngularMotion& motion);

}  // namespace coast::array
