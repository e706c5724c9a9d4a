#include "coast/array/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "clock_edge.hpp"
#include "robust_line.hpp"

namespace coast::array {

namespace {

void require_interval(double interval_s) {
  if (!(interval_s > 0.0) || !std::isfinite(interval_s))
    throw std::invalid_argument(fmt::format("interval_s = {}, must be above 0", interval_s));
}

/// Index of the piece that holds x, by one of the two times.
template <class Of>
std::size_t clock_piece(const std::vector<ClockCurve::Knot>& knots, double x, const Of& of) {
  const auto after = std::upper_bound(knots.begin() + 1, knots.end() - 1, x,
                                      [&](double value, const ClockCurve::Knot& knot) { return value < of(knot); });
  return static_cast<std::size_t>(after - knots.begin()) - 1;
}

struct SyncPulse {
  double device_s;
  double time_s;
};

/// Pulses within half an interval of the time predicted from their neighbour. The first pair that agrees is trusted.
std::vector<SyncPulse> pulses_in_place(const std::vector<SyncPulse>& all, double interval_s) {
  const auto agree = [&](const SyncPulse& a, const SyncPulse& b) {
    const double device = b.device_s - a.device_s;
    return device > 0.0 && std::abs(b.time_s - a.time_s - device) < 0.5 * interval_s + 1e-3 * device;
  };
  std::vector<SyncPulse> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (kept.empty() ? i + 1 < all.size() && agree(all[i], all[i + 1]) : agree(kept.back(), all[i])) kept.push_back(all[i]);
  }
  return kept;
}

}  // namespace

ClockCurve::ClockCurve(std::vector<Knot> knots) : knots_(std::move(knots)) {
  if (knots_.size() < 2) throw std::invalid_argument(fmt::format("{} knots of a clock, must be 2 or more", knots_.size()));
  for (std::size_t k = 1; k < knots_.size(); ++k) {
    const double device = knots_[k].device_s - knots_[k - 1].device_s;
    const double time = device + knots_[k].ahead_s - knots_[k - 1].ahead_s;
    if (!(device > 0.0) || !(time > 0.0))
      throw std::invalid_argument(
          fmt::format("knot {} of a clock is {} s (device) and {} s after the one before", k, device, time));
  }
}

double ClockCurve::time(double device_s) const {
  const std::size_t k = clock_piece(knots_, device_s, [](const Knot& knot) { return knot.device_s; });
  const Knot &a = knots_[k], &b = knots_[k + 1];
  const double slope = (b.ahead_s - a.ahead_s) / (b.device_s - a.device_s);
  return device_s + (a.ahead_s + slope * (device_s - a.device_s));
}

double ClockCurve::device(double time_s) const {
  const std::size_t k = clock_piece(knots_, time_s, [](const Knot& knot) { return knot.device_s + knot.ahead_s; });
  const Knot &a = knots_[k], &b = knots_[k + 1];
  const double slope = (b.ahead_s - a.ahead_s) / (b.device_s - a.device_s);
  // time = d + a + s (d - d_a): the correction is small compared with d and computed separately, so that no digit of d is lost.
  return time_s - (a.ahead_s + slope * (time_s - a.ahead_s - a.device_s) / (1.0 + slope));
}

ClockFit computer_clock(const PacketSegment& master, const ClockOptions& options) {
  std::vector<double> device, arrival;
  for (const Packet& packet : master.packets) {
    if (!packet.master_s) continue;
    device.push_back(*packet.master_s);
    arrival.push_back(packet.arrival_s);
  }
  return fit_clock(device, arrival, options);
}

ClockFit software_clock(const PacketSegment& segment, double interval_s, const ClockFit& computer,
                        const ClockOptions& options) {
  require_interval(interval_s);
  std::vector<double> device, arrival;
  for (const Packet& packet : segment.packets) {
    device.push_back(static_cast<double>(packet.counter) * interval_s);
    arrival.push_back(computer.curve.device(packet.arrival_s));
  }
  return fit_clock(device, arrival, options);
}

ClockFit pulse_clock(const PacketSegment& segment, double interval_s, const PulseTrain& pulses) {
  require_interval(interval_s);
  if (!(pulses.period_s > 0.0)) throw std::invalid_argument(fmt::format("period_s = {}, must be above 0", pulses.period_s));
  std::vector<SyncPulse> all;
  for (const Packet& packet : segment.packets)
    if (packet.pulse)
      all.push_back({static_cast<double>(packet.counter) * interval_s,
                     pulses.first_s + static_cast<double>(*packet.pulse) * pulses.period_s});
  const std::vector<SyncPulse> kept = pulses_in_place(all, interval_s);
  if (kept.size() < 2) throw std::invalid_argument(fmt::format("{} sync pulses in place, must be 2 or more", kept.size()));

  ClockFit fit;
  fit.rejected = all.size() - kept.size();
  std::vector<ClockCurve::Knot> knots;
  std::vector<LinePoint> points;
  for (const SyncPulse& pulse : kept) {
    knots.push_back({pulse.device_s, pulse.time_s - pulse.device_s, 0.0});
    points.push_back({pulse.device_s, pulse.time_s - pulse.device_s, 1.0});
  }
  fit.curve = ClockCurve(std::move(knots));
  fit.reference_s = 0.5 * (kept.front().device_s + kept.back().device_s);
  const RobustLine line = fit_line(points, fit.reference_s, Sigmas::kRelative);
  std::vector<double> residuals;
  for (const LinePoint& point : points) residuals.push_back(point.y - line.at(point.x));
  describe_clock(line, std::move(residuals), fit);
  return fit;
}

std::vector<SamplingInterval> sampling_intervals(const PacketSegment& segment, double interval_s, const ClockFit& clock) {
  require_interval(interval_s);
  std::vector<SamplingInterval> intervals;
  for (std::size_t i = 1; i < segment.packets.size(); ++i) {
    const Packet &before = segment.packets[i - 1], &packet = segment.packets[i];
    if (packet.counter != before.counter + 1) continue;
    const double time = clock.curve.time(static_cast<double>(packet.counter) * interval_s);
    const double time_before = clock.curve.time(static_cast<double>(before.counter) * interval_s);
    intervals.push_back({time, packet.arrival_s - before.arrival_s, time - time_before});
  }
  return intervals;
}

}  // namespace coast::array
