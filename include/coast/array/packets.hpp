#pragma once
// Corrects the packets of one IMU: unwraps counters, detects losses and restarts.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "coast/record/packet.hpp"

namespace coast::array {

using record::Packet;

/// Properties of a device's counter.
struct Counting {
  double interval_s = 0.01;  ///< nominal, between samples, > 0
  std::optional<std::int64_t> modulus =
      std::nullopt;             ///< the counter goes from modulus - 1 to 0 (2^8, 2^16, 2^32); empty: never wraps
  std::int64_t most_late = 64;  ///< packets: a packet later by more than this is not reordered
  double most_delay_s = 1.0;    ///< largest delay of a packet relative to the fastest ones, unless nothing was lost
};

/// Consecutive counters that were not received.
struct LostPackets {
  std::int64_t after = 0;  ///< last counter (unwrapped) before the gap
  std::int64_t count = 0;
  double arrival_s = 0.0;  ///< of the packet before the gap
};

/// Packets between two restarts of the device.
struct PacketSegment {
  std::vector<Packet> packets;  ///< counters unwrapped, strictly increasing; the first one is as received
  std::vector<LostPackets> lost;
};

/// Result of the check, with the corrected packets.
struct PacketReport {
  std::size_t received = 0;
  std::size_t lost = 0;       ///< sum over the segments; losses during a restart are not known
  std::size_t doubled = 0;    ///< duplicates dropped, the first one is kept
  std::size_t reordered = 0;  ///< arrived after a later one, put in order
  std::size_t stray = 0;      ///< counters that fit neither the previous nor the next packets: dropped
  std::vector<PacketSegment> segments;

  [[nodiscard]] std::size_t restarts() const { return segments.empty() ? 0 : segments.size() - 1; }
};

/// Unwraps the counters of one device, and finds lost, duplicate and out-of-order packets and restarts. The number of wraps is
/// ambiguous; of the possible forward steps the one nearest to the time elapsed since the fastest recent packet is chosen. A
/// packet restarts the count if its counter
///
/// - goes back by more than `most_late`, or
/// - is ahead of the elapsed time by more than 0.2 s (drifts are far below that over a second), or
/// - is behind it by more than `most_delay_s` and by a step of more than `most_late` (a stalled computer delays, but then
///   packets come one after the other),
///
/// and the next packet continues from there; if it does not, the packet is a stray.
///
/// @param packets  as received, in order of arrival
/// @throws std::invalid_argument  an option or a counter is outside its range, an arrival time is not finite
/// @note  With a modulus of 2^8 at 100 Hz (2.56 s), a restart is mistaken for a loss if the new counter happens to fit the
///        elapsed time, within the bounds above; a delay of more than half a wrap is mistaken for the loss of a whole one. With
///        2^16 and more neither happens in practice.
[[nodiscard]] PacketReport check_packets(const std::vector<Packet>& packets, const Counting& counting);

}  // namespace coast::array
