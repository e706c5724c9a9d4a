#pragma once
// Packets of one IMU put right: counters unwrapped, losses and restarts found.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "coast/record/packet.hpp"

namespace coast::array {

using record::Packet;

/// How a device counts.
struct Counting {
  double interval_s = 0.01;  ///< nominal, between samples, > 0
  std::optional<std::int64_t> modulus =
      std::nullopt;             ///< the counter goes from modulus - 1 to 0 (2^8, 2^16, 2^32); empty: never wraps
  std::int64_t most_late = 64;  ///< packets: what comes later than by that many is not put in order any more
  double most_delay_s = 1.0;    ///< by which a packet may be later than the fastest ones, unless nothing was lost
};

/// Consecutive counters that never came.
struct LostPackets {
  std::int64_t after = 0;  ///< last counter (unwrapped) before them
  std::int64_t count = 0;
  double arrival_s = 0.0;  ///< of the packet before them
};

/// Packets between two restarts of the device.
struct PacketSegment {
  std::vector<Packet> packets;  ///< counters unwrapped, strictly increasing; the first one is as received
  std::vector<LostPackets> lost;
};

/// What was found, and the packets put right.
struct PacketReport {
  std::size_t received = 0;
  std::size_t lost = 0;       ///< sum over the segments; what was lost while a device restarted is not known
  std::size_t doubled = 0;    ///< dropped, the first one counts
  std::size_t reordered = 0;  ///< came after a later one, put in their places
  std::size_t stray = 0;      ///< counters that fit neither what came before nor what came after: dropped
  std::vector<PacketSegment> segments;

  [[nodiscard]] std::size_t restarts() const { return segments.empty() ? 0 : segments.size() - 1; }
};

/// Unwraps the counters of one device, and finds lost, doubled, out-of-order packets and restarts. A wrapped counter alone
/// does not tell how often it went round; of the possible steps forward that one is taken which lies nearest to the time passed
/// since the fastest packet of the last ones. A packet restarts the count if its counter
///
/// - goes back by more than `most_late`, or
/// - is ahead of the time passed by more than 0.2 s (drifts are far below that over a second), or
/// - is behind it by more than `most_delay_s` and by a step of more than `most_late` (a stalled computer delays, but then
///   packets come one after the other),
///
/// and the next packet goes on from there; if it does not, the packet is a stray.
///
/// @param packets  as received, in order of arrival
/// @throws std::invalid_argument  an option or a counter is outside its range, an arrival time is not finite
/// @note  A restart inside a wrap of 2^8 at 100 Hz (2.56 s) looks like a loss wherever the new counter happens to fit the time
///        passed, within the bounds above; a delay of more than half a wrap looks like the loss of a whole one. With 2^16 and
///        more neither happens in practice.
[[nodiscard]] PacketReport check_packets(const std::vector<Packet>& packets, const Counting& counting);

}  // namespace coast::array
