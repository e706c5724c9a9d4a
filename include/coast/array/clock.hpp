#pragma once
// Sampling times of a device: its clock relative to GPS time, from arrival times or from sync pulses.

#include <cstdint>
#include <vector>

#include "coast/array/packets.hpp"

namespace coast::array {

/// Relation of two clocks: linear between knots, extrapolated beyond the outer ones.
class ClockCurve {
 public:
  struct Knot {
    double device_s = 0.0;  ///< by the device
    double ahead_s = 0.0;   ///< time - device_s
    double sigma_s = 0.0;
  };

  ClockCurve() = default;
  /// @throws std::invalid_argument  fewer than two knots, or one of the two times does not increase
  explicit ClockCurve(std::vector<Knot> knots);

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }
  /// Converts device time to time; O(log knots).
  [[nodiscard]] double time(double device_s) const;
  /// Converts time to device time.
  [[nodiscard]] double device(double time_s) const;

 private:
  std::vector<Knot> knots_;
};

/// For packets: arrival minus curve. For pulses: pulse minus straight line.
struct ClockResiduals {
  std::size_t count = 0;
  double minimum = 0.0;  ///< s
  double median = 0.0;
  double percentile95 = 0.0;
  double maximum = 0.0;
};

/// A clock curve, and the straight line fitted to it:  time = device + offset + drift (device - reference).
struct ClockFit {
  ClockCurve curve;
  double reference_s = 0.0;      ///< device time, middle of the record
  double offset_s = 0.0;         ///< at reference_s
  double drift_ppm = 0.0;        ///< positive: the device's second is longer than a second
  double offset_sigma_s = 0.0;   ///< random part; a delay common to all packets is not included
  double drift_sigma_ppm = 0.0;  ///< of the straight line: if the clock is curved, it applies to the mean only
  ClockResiduals residuals;
  std::size_t rejected = 0;  ///< rejected pulses
};

struct ClockOptions {
  double quantile = 0.05;  ///< quantile of the delays that is used as zero delay, (0, 0.5]
  double block_s = 5.0;    ///< one quantile is computed per block
  double knot_s = 60.0;    ///< between knots; records shorter than three of these have a straight line
};

/// A clock from the arrival times of its packets (software synchronisation). Arrival is device time, on the other clock, plus a
/// delay that is positive, jitters and has a heavy tail, so the clock is the lower edge of arrival - device as a function of
/// device time: a low quantile of every block of seconds, and robust (piecewise linear) fits through these. The chosen quantile
/// is used as zero delay; it is later than the fastest packets by -residuals.minimum.
///
///     var(quantile q of n packets) = q (1 - q)/(n p^2),    p the density of the delays there;
///
/// stated errors come from the scatter of the blocks, including correlation of neighbours. With exponential delays of 2 ms mean
/// at 100 Hz over 600 s: 2 us and 0.01 ppm.
///
/// @param device_s   by the device, strictly increasing
/// @param arrival_s  arrival times of the same packets
/// @throws std::invalid_argument  different sizes, times not finite or not increasing, an option outside its range, fewer than
///         60 packets
/// @note  A delay common to all packets cannot be separated from an offset: the curve is late by it. Most of it is common to
///        device and master on the same computer; the rest can be estimated from the signals (alignment.hpp).
[[nodiscard]] ClockFit fit_clock(const std::vector<double>& device_s, const std::vector<double>& arrival_s,
                                 const ClockOptions& options = {});

/// The computer's clock from the master's packets, which carry GPS time: device_s of the result is GPS time, time is the
/// computer's, so `curve.device(arrival)` is the GPS time of an arrival. Packets without `master_s` are not used.
/// @throws std::invalid_argument  as fit_clock
[[nodiscard]] ClockFit computer_clock(const PacketSegment& master, const ClockOptions& options = {});

/// A device in software synchronisation: device time is counter * interval, time is GPS time.
/// @param interval_s  nominal, > 0
/// @param computer    result of `computer_clock`
/// @throws std::invalid_argument  as fit_clock
[[nodiscard]] ClockFit software_clock(const PacketSegment& device, double interval_s, const ClockFit& computer,
                                      const ClockOptions& options = {});

/// Pulse n is at first_s + n period_s of GPS time.
struct PulseTrain {
  double first_s = 0.0;
  double period_s = 1.0;
};

/// A device in hardware synchronisation: the samples triggered by pulses have known times, those between are equally spaced.
/// Device time is counter * interval. A pulse that disagrees with its neighbours by more than half an interval is rejected.
/// @throws std::invalid_argument  interval or period not above zero, fewer than two valid pulses
[[nodiscard]] ClockFit pulse_clock(const PacketSegment& device, double interval_s, const PulseTrain& pulses);

/// Intervals between samples with consecutive counters, by arrival times and by the clock.
struct SamplingInterval {
  double time_s = 0.0;       ///< of the later sample, by the clock
  double arrival_s = 0.0;    ///< difference of arrivals
  double corrected_s = 0.0;  ///< difference by the clock
};
/// The comparison of Stebler et al. (2011), Fig. 8.
[[nodiscard]] std::vector<SamplingInterval> sampling_intervals(const PacketSegment& device, double interval_s,
                                                               const ClockFit& clock);

}  // namespace coast::array
