#pragma once
// Converts packets to a recording with GPS times: one clock per device, Stebler et al. (2011), section III.B.

#include <optional>
#include <vector>

#include "coast/array/clock.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/packet.hpp"

namespace coast::array {

struct TimedRecording {
  record::ImuRecording imu;                 ///< tagged with GPS time, end of the interval
  PacketReport report;                      ///< lost, duplicate and out-of-order packets
  std::vector<ClockFit> clocks;             ///< one per segment that has one
  std::vector<SamplingInterval> intervals;  ///< of the paper's Fig. 8
};

/// Software synchronisation: the device's samples by its counter and the computer's clock.
/// @param computer  `computer_clock` of the master's packets  @param week  GPS week of the master's seconds
/// @throws std::invalid_argument  as check_packets and fit_clock; no segment with enough packets for a clock
[[nodiscard]] TimedRecording time_by_packets(const record::PacketRecording& packets, const Counting& counting,
                                             const ClockFit& computer, int week);

/// Hardware synchronisation: the device's samples by its counter and the pulses that triggered some of them.
[[nodiscard]] TimedRecording time_by_pulses(const record::PacketRecording& packets, const Counting& counting,
                                            const PulseTrain& pulses, int week);

/// The computer's clock from a recording whose packets carry GPS seconds of week.
/// @throws std::invalid_argument  as fit_clock
[[nodiscard]] ClockFit computer_clock_of(const record::PacketRecording& master, const Counting& counting);

}  // namespace coast::array
