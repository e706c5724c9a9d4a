#pragma once
// Converts recordings of several IMUs to signals that can be merged: on one time grid, in one frame, without defective sensors.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coast/array/alignment.hpp"
#include "coast/array/defects.hpp"
#include "coast/array/mounting.hpp"
#include "coast/array/saturation.hpp"
#include "coast/array/signals.hpp"
#include "coast/record/imu.hpp"

namespace coast::array {

/// One IMU of the array.
struct ArrayMember {
  std::string name;
  const record::ImuRecording* recording = nullptr;  ///< in its own axes; outlives the assembly
  SensorFrame frame;                                ///< as stated
};

struct AssemblyOptions {
  double rate_hz = 0.0;                           ///< of the grid; 0: the first member's
  std::optional<LagOptions> lags = LagOptions{};  ///< relative to the first member; absent: tags are used as they are
  std::optional<MountingOptions> mounting;        ///< absent: stated frames are used
  std::optional<DefectOptions> defects = DefectOptions{};
  double offset_window_s = 30.0;  ///< slower differences of the sensors do not count as noise in the weights
};

struct Assembly {
  Signals signals;   ///< body axes, at the origin, defective periods excluded; biases included
  Signals levelled;  ///< the same without the offsets between sensors: input of the merge
  std::vector<SensorFrame> frames;
  std::vector<std::optional<LagCurve>> lags;  ///< relative to the first; empty if tags are used as they are
  std::optional<RefinedMounting> mounting;
  std::vector<Saturation> saturation;  ///< of each member
  int differentiator_half_width = 0;
  double alpha_error_sd = 0.0;  ///< rad/s^2
  DefectReport defects;
  record::Events events;
};

/// In this order: resamples, estimates and corrects lags, refines the mounting, repeats both, leaves out what is at the end of
/// a sensor's range, moves to the body's origin, finds and excludes defective sensors, subtracts offsets. A jump in a sensor's
/// bias is subtracted.
/// @param progress  called with the current step and the fraction done
/// @throws std::invalid_argument  fewer than two members, or recordings that overlap by less than 20 s
[[nodiscard]] Assembly assemble(const std::vector<ArrayMember>& members, const AssemblyOptions& options,
                                const std::function<void(const char*, double)>& progress = {});

}  // namespace coast::array
