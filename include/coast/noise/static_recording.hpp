#pragma once
// Signals of the axes from a recording of an IMU at rest, and the turn-on bias from the levels of such recordings.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coast/noise/process.hpp"
#include "coast/noise/static_signal.hpp"
#include "coast/record/imu.hpp"

namespace coast::noise {

/// Part of a recording, s from the start of its first interval: samples with from_s < tag <= to_s whose intervals lie within
/// it.
struct RecordingPart {
  std::optional<double> from_s;
  std::optional<double> to_s;
};

/// The six axes of an IMU at rest on one regular grid.
struct StaticRecording {
  std::string source;
  double interval = 0.0;             ///< s, mean step between consecutive samples
  std::vector<StaticSignal> axes;    ///< gyro x, y, z in rad/s, accelerometer x, y, z in m/s^2; sensor axes
  std::vector<std::string> remarks;  ///< what was left out or rounded, a sentence each

  [[nodiscard]] const StaticSignal& of(Sensor sensor, int axis) const {
    return axes.at(static_cast<std::size_t>(axis) + (sensor == Sensor::kGyro ? 0U : 3U));
  }
};

/// Mean rate and specific force over each interval, increment/dt. A step longer than 1.5 median intervals is a hole: it is
/// rounded to whole intervals, and the sample after it, whose increment the reader interpolated, is left out.
/// @throws InputError  fewer than two samples, or none in the part
[[nodiscard]] StaticRecording static_recording(const record::ImuRecording& imu, const RecordingPart& part = {});

/// Gives recordings of one sensor the common interval that estimators need: the mean weighted by samples. A remark is added if
/// the recordings' own intervals differ by more than 1e-6 of it.
/// @throws InputError  intervals differ by more than 1 %: not the same rate
void share_interval(std::vector<StaticRecording>& recordings);

/// Prior standard deviation of the constant bias, and where it comes from.
struct TurnOnBias {
  double sigma = 0.0;  ///< rad/s or m/s^2
  std::string source;  ///< one line for people
};
/// Gyro: the root mean square of all levels if it is above three times the Earth's rate, so that the Earth's rate is a small
/// part of it; else the standard deviation of an axis between recordings; else, for one recording, three times the Earth's
/// rate. Accelerometer: the standard deviation of an axis between recordings, combined with the mean norm minus 9.80665 m/s^2
/// if that is above 0.03 m/s^2, more than gravity varies over the Earth; a default of 20 mg if neither is known. Recordings in
/// several attitudes differ by gravity, not by bias: then a sigma must be stated.
/// @param levels  one per recording: mean of axes x, y, z
[[nodiscard]] TurnOnBias turn_on_bias(Sensor sensor, std::span<const std::array<double, 3>> levels);

}  // namespace coast::noise
