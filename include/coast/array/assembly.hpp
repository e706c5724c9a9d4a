#pragma once
// From the recordings of several IMUs to signals that can be merged: one grid of times, one frame, the defective ones left out.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coast/array/alignment.hpp"
#include "coast/array/defects.hpp"
#include "coast/array/mounting.hpp"
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
  std::optional<LagOptions> lags = LagOptions{};  ///< against the first member; absent: tags are believed
  std::optional<MountingOptions> mounting;        ///< absent: stated frames are believed
  std::optional<DefectOptions> defects = DefectOptions{};
  double offset_window_s = 30.0;  ///< slower differences of the sensors are not noise to be weighed
};

struct Assembly {
  Signals signals;   ///< body axes, at the origin, defective stretches excluded; biases as they are
  Signals levelled;  ///< the same without the sensors' offsets from each other: what is merged
  std::vector<SensorFrame> frames;
  std::vector<std::optional<LagCurve>> lags;  ///< against the first; empty where tags are believed
  std::optional<RefinedMounting> mounting;
  int differentiator_half_width = 0;
  double alpha_error_sd = 0.0;  ///< rad/s^2
  DefectReport defects;
  record::Events events;
};

/// Resamples, finds lags and takes them out, refines the mounting, moves to the body's origin, finds and excludes defective
/// sensors, takes off offsets, in this order. A sensor's bias that has jumped is taken back to what it was before.
/// @param progress  told what is being done, and the share that is done
/// @throws std::invalid_argument  fewer than two members, or recordings that overlap by less than 20 s
[[nodiscard]] Assembly assemble(const std::vector<ArrayMember>& members, const AssemblyOptions& options,
                                const std::function<void(const char*, double)>& progress = {});

}  // namespace coast::array
