#include "coast/array/packets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace coast::array {

namespace {

constexpr double kMostAheadSeconds = 0.2;

void validate_packets(const std::vector<Packet>& packets, const Counting& counting) {
  if (!(counting.interval_s > 0.0) || !std::isfinite(counting.interval_s))
    throw std::invalid_argument(fmt::format("interval_s = {}, must be above 0", counting.interval_s));
  if (counting.most_late < 1) throw std::invalid_argument(fmt::format("most_late = {}, must be 1 or more", counting.most_late));
  if (!(counting.most_delay_s > 0.0))
    throw std::invalid_argument(fmt::format("most_delay_s = {}, must be above 0", counting.most_delay_s));
  if (counting.modulus && *counting.modulus <= 2 * counting.most_late)
    throw std::invalid_argument(
        fmt::format("modulus = {}, must be above twice most_late = {}", *counting.modulus, counting.most_late));
  for (const Packet& packet : packets) {
    if (!std::isfinite(packet.arrival_s))
      throw std::invalid_argument(fmt::format("arrival_s = {} of counter {}", packet.arrival_s, packet.counter));
    if (counting.modulus && (packet.counter < 0 || packet.counter >= *counting.modulus))
      throw std::invalid_argument(fmt::format("counter = {}, must be in [0, {})", packet.counter, *counting.modulus));
  }
}

/// Orders the packets of one device, one after the other.
class Unwrapping {
 public:
  explicit Unwrapping(const Counting& counting) : counting_(counting) {}

  /// @param next  the packet received after this one, if there is one: it confirms a restart
  void take(const Packet& packet, const Packet* next) {
    ++report_.received;
    if (report_.segments.empty()) return start(packet);
    const std::optional<std::int64_t> counter = unwrapped(packet);
    if (!counter) {
      if (next != nullptr && goes_on(packet, *next)) return start(packet);
      ++report_.stray;
      return;
    }
    place(packet, *counter);
    if (delay(*counter, packet.arrival_s) <= delay(fastest_counter_, fastest_arrival_) ||
        *counter - fastest_counter_ > kForget) {
      fastest_counter_ = *counter;
      fastest_arrival_ = packet.arrival_s;
    }
  }

  [[nodiscard]] PacketReport finish() {
    for (PacketSegment& segment : report_.segments) {
      for (std::size_t i = 1; i < segment.packets.size(); ++i) {
        const Packet& before = segment.packets[i - 1];
        const std::int64_t missing = segment.packets[i].counter - before.counter - 1;
        if (missing > 0) segment.lost.push_back({before.counter, missing, before.arrival_s});
      }
      for (const LostPackets& lost : segment.lost) report_.lost += static_cast<std::size_t>(lost.count);
    }
    return std::move(report_);
  }

 private:
  static constexpr std::int64_t kForget = 1000;  // packets: 1000 ppm of this are one packet

  [[nodiscard]] double delay(std::int64_t counter, double arrival_s) const {
    return arrival_s - static_cast<double>(counter) * counting_.interval_s;
  }

  void start(const Packet& packet) {
    report_.segments.emplace_back().packets.push_back(packet);
    fastest_counter_ = packet.counter;
    fastest_arrival_ = packet.arrival_s;
  }

  /// Of all counter values congruent to this one the closest to the elapsed time, if it fits.
  [[nodiscard]] std::optional<std::int64_t> unwrapped(const Packet& packet) const {
    const std::int64_t newest = report_.segments.back().packets.back().counter;
    const double by_time =
        static_cast<double>(fastest_counter_ - newest) + (packet.arrival_s - fastest_arrival_) / counting_.interval_s;
    std::int64_t step = packet.counter - newest;
    if (counting_.modulus) {
      const std::int64_t modulus = *counting_.modulus;
      step = ((step % modulus) + modulus) % modulus;
      const double rounds = std::round((by_time - static_cast<double>(step)) / static_cast<double>(modulus));
      const std::int64_t fewest = modulus - step <= counting_.most_late ? -1 : 0;  // -1: it is late
      step += modulus * std::max(fewest, static_cast<std::int64_t>(rounds));
    }
    if (!fits(step, by_time)) return {};
    return newest + step;
  }

  [[nodiscard]] bool fits(std::int64_t step, double by_time) const {
    if (step <= 0) return step >= -counting_.most_late;
    const double ahead_s = (static_cast<double>(step) - by_time) * counting_.interval_s;
    if (ahead_s > kMostAheadSeconds) return false;
    return step <= counting_.most_late || ahead_s >= -counting_.most_delay_s;
  }

  [[nodiscard]] bool goes_on(const Packet& packet, const Packet& next) const {
    std::int64_t step = next.counter - packet.counter;
    if (counting_.modulus && step < 0) step += *counting_.modulus;
    return step > 0 && step <= counting_.most_late;
  }

  void place(Packet packet, std::int64_t counter) {
    packet.counter = counter;
    std::vector<Packet>& packets = report_.segments.back().packets;
    auto at = packets.end();
    while (at != packets.begin() && std::prev(at)->counter > counter) --at;
    if (at != packets.begin() && std::prev(at)->counter == counter) {
      ++report_.doubled;
      return;
    }
    // Late, but older than the first of its segment: it belongs to the time before the restart.
    if (at == packets.begin()) {
      ++report_.stray;
      return;
    }
    if (at != packets.end()) ++report_.reordered;
    packets.insert(at, packet);
  }

  Counting counting_;
  PacketReport report_;
  std::int64_t fastest_counter_ = 0;
  double fastest_arrival_ = 0.0;
};

}  // namespace

PacketReport check_packets(const std::vector<Packet>& packets, const Counting& counting) {
  validate_packets(packets, counting);
  Unwrapping unwrapping(counting);
  for (std::size_t i = 0; i < packets.size(); ++i)
    unwrapping.take(packets[i], i + 1 < packets.size() ? &packets[i + 1] : nullptr);
  return unwrapping.finish();
}

}  // namespace coast::array
