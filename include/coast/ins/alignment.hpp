#pragma once
// Initial state of a mission: from standstill, or from GNSS course and velocity if the IMU moves at the start.

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

/// Static periods from the IMU and, if given, from GNSS. A period is static if the specific force equals gravity to 0.7 m/s^2
/// and the rate is below 6 deg/s (biases of a poor MEMS), the scatter of quarter-second means is at most 12 times that of the
/// quietest 5 % of the recording (at most 0.3 m/s^2, 1 deg/s), and neither GNSS velocity nor displacement over a second shows
/// motion. Works with engine vibration, because fast noise averages out.
[[nodiscard]] std::vector<StaticPeriod> find_static_periods(const record::ImuRecording& body, const record::GnssRecording* gnss,
                                                            double min_duration_s = 2.0);

/// State with standard deviations (N, E, D; attitude as rotations about N, E, D).
struct InitialState {
  record::NavState nav;
  Eigen::Vector3d sd_position_n;
  Eigen::Vector3d sd_velocity_n;
  Eigen::Vector3d sd_attitude_n;
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();  ///< body axes, rad/s; from standstill or motion
  std::optional<double> gyro_bias_sd;                   ///< of each component, if it was estimated at standstill
  std::string method;  ///< for people: "levelled over 35.2 s standing still, heading from GNSS course at ..."
};

/// Input of the alignment: recordings, lever arm and the IMU's grade.
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
/// At standstill: levels over the static period and estimates the gyro bias from it; heading by gyrocompassing if gyro bias and
/// noise allow better than 2 deg. In all other cases attitude and biases come from motion: means of specific force over
/// seconds, with the attitude propagated by the gyro, are matched with the antenna's accelerations (second differences of
/// position, or velocities if less noisy) over windows of 10 to 80 s (twelve fix intervals if longer), the first that gives 1
/// deg of heading or the best of 10 min; the attitude is then propagated back to the start by the gyro. No attitude is assumed;
/// unknown gyro biases of degrees per second are estimated as well. For a moving start, velocity and position come from the
/// fixes after it, with the motion between them from the IMU. The standard deviations follow from the residuals and are
/// conservative.
/// @param vehicle_forward  body x points along the velocity to 4 deg (one sigma, mounting and sideslip): helps if there is
///                         little acceleration; driving backwards is detected from the specific force
/// @throws NumericalError  IMU and GNSS do not overlap; too little motion for 15 deg of heading and no gyrocompassing: the
///                         message states what to set under `start:`
[[nodiscard]] InitialState align(const AlignmentInput& input, bool vehicle_forward);

}  // namespace coast::ins
