#pragma once
// A plain-language check of what was understood of a recording: the first thing on the terminal and in the report.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "coast/record/event.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"

namespace coast::io {

/// What the recording says about itself. Numbers that could not be had are absent.
struct Inspection {
  std::vector<std::string> sentences;  ///< in reading order
  record::Events events;  ///< what looks wrong, with the key to set; also those of the readers are not repeated here

  double overlap_s = 0.0;                  ///< common interval of IMU and GNSS
  long repeated_samples = 0;               ///< IMU samples equal to the one before in all six values
  std::optional<Eigen::Vector3d> f_rest;   ///< mean specific force at rest, m/s^2, body axes
  bool rest_seen = false;                  ///< false: f_rest is of the quietest seconds only
  std::optional<double> gravity;           ///< normal gravity at the first fix, m/s^2
  std::optional<double> time_shift_s;      ///< add to GNSS times to match the IMU (= -gnss.time_offset_s), to about 0.05 s
  std::optional<double> time_correlation;  ///< of course rate with turn rate at that shift, [-1, 1]
  std::optional<double> gyro_slope;        ///< turn rate about the vertical against course rate; 1 if units and signs are right
  std::optional<double> travel_yaw;        ///< where z points down: direction of travel against x, clockwise, rad
};

/// Looks at an IMU recording, in the axes that the configuration says are forward, right, down, together with the GNSS fixes.
/// Pure; changes nothing. Seconds of work at most, whatever the length.
///
/// Gravity: over the seconds in which GNSS stands still (below 0.1 to 0.3 m/s), else over the quietest 2 % of seconds, the
/// specific force is minus gravity: its sign names the axis that points up, its size the unit.
/// Time: the course rate of GNSS against the turn rate about the vertical, shifts from -45 to 45 s; no use of the axes.
/// Axes: acceleration along and across the course against the levelled specific force, one angle by least squares; it means
/// the mounting only where the vehicle moves along its own forward axis.
[[nodiscard]] Inspection inspect(const record::ImuRecording& body, const record::GnssRecording& gnss);

/// The same for an IMU alone (calibration): span, rate, gaps, repetitions, size of the specific force.
[[nodiscard]] Inspection inspect(const record::ImuRecording& imu);

}  // namespace coast::io
