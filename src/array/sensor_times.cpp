#include "coast/array/sensor_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

namespace coast::array {

namespace {

constexpr std::size_t kFewestPackets = 60;  // required by fit_clock

/// Samples of one segment, with the times of its clock. An interval begins at the sample before, or has the clock's length if
/// that sample was lost.
void append(const record::PacketRecording& packets, const PacketSegment& segment, double interval, const ClockFit& clock,
            int week, record::ImuRecording& imu) {
  for (const record::Packet& packet : segment.packets) {
    const double device = static_cast<double>(packet.counter) * interval;
    const double to = clock.curve.time(device);
    const double dt = to - clock.curve.time(device - interval);
    record::ImuSample sample;
    sample.t = geo::GpsTime::from_week(week, to);
    if (!imu.samples.empty() && !(imu.samples.back().t < sample.t)) continue;  // a restarted device: the clocks overlap
    sample.dt = imu.samples.empty() ? dt : sample.t - imu.samples.back().t;
    sample.dtheta = sample.dt * packets.rates.at(packet.row);
    sample.dv = sample.dt * packets.forces.at(packet.row);
    imu.samples.push_back(sample);
  }
}

TimedRecording timed(const record::PacketRecording& packets, const Counting& counting, int week,
                     const std::function<ClockFit(const PacketSegment&)>& clock_of) {
  TimedRecording result;
  result.report = check_packets(packets.packets, counting);
  result.imu.source = packets.source;
  result.imu.rate_hz = 1.0 / counting.interval_s;
  result.imu.events = packets.events;
  for (const PacketSegment& segment : result.report.segments) {
    if (segment.packets.size() < kFewestPackets) continue;
    result.clocks.push_back(clock_of(segment));
    append(packets, segment, counting.interval_s, result.clocks.back(), week, result.imu);
    const std::vector<SamplingInterval> intervals = sampling_intervals(segment, counting.interval_s, result.clocks.back());
    result.intervals.insert(result.intervals.end(), intervals.begin(), intervals.end());
  }
  if (result.clocks.empty())
    throw std::invalid_argument(
        fmt::format("{}: no {} packets without a restart: no clock can be told from them", packets.source, kFewestPackets));
  return result;
}

}  // namespace

TimedRecording time_by_packets(const record::PacketRecording& packets, const Counting& counting, const ClockFit& computer,
                               int week) {
  return timed(packets, counting, week,
               [&](const PacketSegment& segment) { return software_clock(segment, counting.interval_s, computer); });
}

TimedRecording time_by_pulses(const record::PacketRecording& packets, const Counting& counting, const PulseTrain& pulses,
                              int week) {
  return timed(packets, counting, week,
               [&](const PacketSegment& segment) { return pulse_clock(segment, counting.interval_s, pulses); });
}

ClockFit computer_clock_of(const record::PacketRecording& master, const Counting& counting) {
  const PacketReport report = check_packets(master.packets, counting);
  const auto longest =
      std::ranges::max_element(report.segments, {}, [](const PacketSegment& segment) { return segment.packets.size(); });
  if (longest == report.segments.end()) throw std::invalid_argument(fmt::format("{}: no packets", master.source));
  return computer_clock(*longest);
}

}  // namespace coast::array
