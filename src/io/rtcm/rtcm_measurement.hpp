#pragma once
// What a message of RTCM says of one signal. Private to the room.

#include <optional>
#include <utility>
#include <vector>

#include "../frames/frame.hpp"
#include "coast/record/satellite.hpp"

namespace coast::io {

struct RtcmMeasurement {
  record::Satellite satellite;
  record::Signal signal;
  std::optional<double> code_m;
  std::optional<double> phase_m;
  std::optional<double> rate_mps;  ///< of the phase, grows with range
  std::optional<double> cn0_dbhz;
  bool half_cycle = false;  ///< not resolved
  double lock_s = 0.0;      ///< the phase has been locked for at least this long
  /// 1002 to 1012 state the phase against this code, and turn the difference back by 1500 cycles where it grows too large.
  std::optional<double> turns_about_m = {};
};

struct RtcmMeasurements {
  std::vector<RtcmMeasurement> signals;
  std::vector<std::pair<int, int>> glonass_channels;  ///< slot and frequency number, where the message states them
  long unknown = 0;                                   ///< satellites and signals without a name
};

/// MSM4 to MSM7 (RTCM 10403.3, 3.5.16).
/// @return  none if the message is shorter than its masks say, or has more than 64 cells
[[nodiscard]] std::optional<RtcmMeasurements> read_msm(const MessageFrame& frame);
/// 1002, 1004, 1010, 1012 (3.5.1 and 3.5.3).
/// @return  none if the message is shorter than its number of satellites says
[[nodiscard]] std::optional<RtcmMeasurements> read_legacy(const MessageFrame& frame);

}  // namespace coast::io
