#pragma once
// Initial state of a mission: from standstill, or from GNSS course and velocity where the IMU starts moving.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::ins {

/// A period [first, last] of samples in which the IMU stands still.
struct StaticPeriod {
  std::size_t first = 0;
  std::size_t last = 0;  ///< inclusive
};

/// Static periods from the IMU and, where given, from GNSS. A period is static where the specific force is gravity to 0.7 m/s^2
/// and the rate below 6 deg/s (biases of a poor MEMS), means over a quarter of a second scatter no more than 12 times what the
/// quietest 5 % of the recording show (at most 0.3 m/s^2, 1 deg/s), and neither GNSS velocity nor displacement over a second
/// tells of motion. Works for an IMU shaken by an engine: the fast noise does not count.
[[nodiscard]] std::vector<StaticPeriod> find_static_periods(const record::ImuRecording& body, const record::GnssRecording* gnss,
                                                            double min_duration_s = 2.0);

/// State with standard deviations (N, E, D; attitude as rotations about N, E, D).
struct InitialState {
  record::NavState nav;
  Eigen::Vector3d sd_position_n;
  Eigen::Vector3d sd_velocity_n;
  Eigen::Vector3d sd_attitude_n;
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();  ///< body axes, rad/s; from standstill or motion
  std::optional<double> gyro_bias_sd;                   ///< of each component, where it was seen standing still
  std::string method;  ///< for people: "levelled over 35.2 s standing still, heading from GNSS course at ..."
};

/// What the alignment needs to know of the IMU's grade.
struct AlignmentInput {
  const record::ImuRecording& imu;  ///< body axes
  const record::GnssRecording& gnss;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  double gyro_noise_density = 0.0;  ///< rad/sqrt(s)
  double gyro_bias_sd = 0.0;        ///< rad/s, total turn-on bias
  double accel_bias_sd = 0.0;       ///< m/s^2
};

/// `start: auto`: the state at the first IMU epoch that has GNSS.
///
/// Standing still there: levels over the static period and takes the gyro bias from it; heading by gyrocompassing where gyro
/// bias and noise allow better than 2 deg. In all other cases attitude and biases come from motion: means of specific force
/// over seconds, carried by the gyro, are matched with the antenna's accelerations (second differences of position, or
/// velocities where these are less noisy) over windows of 10 to 80 s (twelve intervals between fixes where these are longer),
/// the first that gives 1 deg of heading or the best of 10 min; the attitude is then carried back to the start by the gyro. No
/// assumption on how the body points; unknown gyro biases of degrees per second are found along the way. Velocity and position
/// of a moving start from the fixes behind it, with the motion between them as the IMU felt it. The standard deviations are
/// what the residuals say, on the safe side.
/// @param vehicle_forward  body x points along the velocity to 4 deg (one sigma, mounting and sideslip): helps where there is
///                         little acceleration; driving backwards is recognised by the forces
/// @throws NumericalError  IMU and GNSS do not overlap; too little motion for 15 deg of heading and no gyrocompassing: the
///                         message says what to give under `start:`
[[nodiscard]] InitialState align(const AlignmentInput& input, bool vehicle_forward);

}  // namespace coast::ins
