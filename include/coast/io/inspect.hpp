#pragma once
// A plain-language check of how a recording was interpreted: the first output on the terminal and in the report.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "coast/record/event.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"

namespace coast::io {

/// What was found in the recording. Numbers that could not be determined are absent.
struct Inspection {
  std::vector<std::string> sentences;  ///< in reading order
  record::Events events;               ///< what looks wrong, with the key to set; events of the readers are not repeated here

  double overlap_s = 0.0;                  ///< common interval of IMU and GNSS
  long repeated_samples = 0;               ///< IMU samples equal to the previous one in all six values
  std::optional<Eigen::Vector3d> f_rest;   ///< mean specific force at rest, m/s^2, body axes
  bool rest_seen = false;                  ///< false: f_rest is from the quietest seconds only
  std::optional<double> gravity;           ///< normal gravity at the first fix, m/s^2
  std::optional<double> time_shift_s;      ///< add to GNSS times to match the IMU (= -gnss.time_offset_s), to about 0.05 s
  std::optional<double> time_correlation;  ///< correlation of course rate and turn rate at that shift, [-1, 1]
  std::optional<double> gyro_slope;  ///< slope of turn rate about the vertical over course rate; 1 if units and signs are right
  std::optional<double> travel_yaw;  ///< if z points down: direction of travel relative to x, clockwise, rad
};

/// Checks an IMU recording, in the configured forward, right, down axes, together with the GNSS fixes. Changes nothing. Takes
/// seconds at most, for any length.
///
/// Gravity: over the seconds with GNSS at standstill (below 0.1 to 0.3 m/s), else over the quietest 2 % of seconds, the
/// specific force is minus gravity: its sign shows the axis that points up, its size the unit. Time: GNSS course rate
/// correlated with the turn rate about the vertical, shifts from -45 to 45 s; independent of the axes. Axes: acceleration along
/// and across the course compared with the levelled specific force, one angle by least squares; it is the mounting angle only
/// if the vehicle moves along its forward axis.
[[nodiscard]] Inspection inspect(const record::ImuRecording& body, const record::GnssRecording& gnss);

/// The same for GNSS alone: span, rate, gaps, quality, stated sigmas.
[[nodiscard]] Inspection inspect(const record::GnssRecording& gnss);

/// The same for an IMU alone (calibration): span, rate, gaps, repetitions, size of the specific force.
[[nodiscard]] Inspection inspect(const record::ImuRecording& imu);

}  // namespace coast::io
