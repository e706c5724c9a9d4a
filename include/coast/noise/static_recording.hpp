#pragma once
// From a recording of an IMU at rest to the signals of its axes, and what the levels of such recordings say of the turn-on
// bias.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coast/noise/process.hpp"
#include "coast/noise/static_signal.hpp"
#include "coast/record/imu.hpp"

namespace coast::noise {

/// Part of a recording, s from the begin of its first interval: samples with from_s < tag <= to_s, whose intervals lie within.
struct RecordingPart {
  std::optional<double> from_s;
  std::optional<double> to_s;
};

/// The six axes of an IMU at rest on one regular grid.
struct StaticRecording {
  std::string source;
  double interval = 0.0;             ///< s, mean step between samples that follow each other
  std::vector<StaticSignal> axes;    ///< gyro x, y, z in rad/s, accelerometer x, y, z in m/s^2; sensor axes
  std::vector<std::string> remarks;  ///< what was left out and rounded, a sentence each

  [[nodiscard]] const StaticSignal& of(Sensor sensor, int axis) const {
    return axes.at(static_cast<std::size_t>(axis) + (sensor == Sensor::kGyro ? 0U : 3U));
  }
};

/// Mean rate and specific force over each interval, increment/dt. A step longer than 1.5 median intervals is a hole: it is
/// rounded to whole intervals, and the sample behind it, whose increment the reader bridged, is left out.
/// @throws InputError  fewer than two samples, or none in the part
[[nodiscard]] StaticRecording static_recording(const record::ImuRecording& imu, const RecordingPart& part = {});

/// Puts recordings of one sensor on the grid that estimators need: one interval, the mean weighted by samples. A remark says so
/// where the recordings' own differ by more than 1e-6 of it.
/// @throws InputError  they differ by more than 1 %: not the same rate
void share_interval(std::vector<StaticRecording>& recordings);

/// Prior standard deviation of the constant bias, and where it comes from.
struct TurnOnBias {
  double sigma = 0.0;  ///< rad/s or m/s^2
  std::string source;  ///< one line for people
};
/// Of a gyro: the root mean square of all levels about zero where that is beyond three times the Earth's rate, so that the
/// Earth's rate is little of it; else the standard deviation of an axis between recordings; else, of one recording, three times
/// the Earth's rate.
/// Of an accelerometer: the standard deviation of an axis between recordings, and beside it the mean norm minus 9.80665 m/s^2
/// where that is beyond 0.03 m/s^2, which gravity's own variation over the Earth does not reach; a default of 20 mg where
/// neither is known. Recordings in several attitudes spread by gravity, not by their bias: then a sigma must be stated.
/// @param levels  one per recording: mean of axes x, y, z
[[nodiscard]] TurnOnBias turn_on_bias(Sensor sensor, std::span<const std::array<double, 3>> levels);

}  // namespace coast::noise
