#pragma once
// One IMU's recording on the array's common grid of times.

#include <cstddef>
#include <functional>

#include "coast/array/signals.hpp"
#include "coast/record/imu.hpp"

namespace coast::array {

/// Columns are means over (start + n dt, start + (n + 1) dt].
struct Grid {
  geo::GpsTime start;
  double dt = 0.01;  ///< s, > 0
  std::size_t samples = 0;
};

/// A lag that changes evenly with the tag. What is tagged t happened at t - at(t).
struct LinearLag {
  geo::GpsTime epoch;
  double offset_s = 0.0;   ///< at the epoch
  double drift_ppm = 0.0;  ///< positive: the tags gain

  [[nodiscard]] double at(geo::GpsTime tag) const { return offset_s + 1e-6 * drift_ppm * (tag - epoch); }
  [[nodiscard]] double operator()(geo::GpsTime tag) const { return at(tag); }
};

/// Lag [s] of a tag; empty: none.
using LagOfTag = std::function<double(geo::GpsTime)>;

/// Means of rates and specific forces on a grid, from increments over (t - dt, t] with their own clock.
///
/// Interpolated are the mean rates, increment over true interval, by a sinc under a Kaiser window of 32 taps. Both sides are
/// means, over T on one and dt on the other, so the kernel's spectrum is that of the low-pass times sinc(f dt)/sinc(f T): it
/// makes means of one length of means of another, and with dt = T is a plain interpolation. Its weights are normalised: a
/// constant rate comes out exactly, and angles add up. On a coarser grid the low-pass is that of the grid and the taps are as
/// many more. With f_s the lower of both sampling frequencies, amplitudes are right to 3e-5 up to 0.4 f_s (0.8 of Nyquist's
/// frequency); what the grid cannot hold is damped from there on, to 3e-5 above 0.6 f_s.
///
/// Time runs by the corrected tags. Intervals that change slowly (clocks) are followed exactly. Where tags jitter about a
/// smooth clock (a moving mean over 65 tags, taken twice), they are believed: the cumulative increments are first read at the
/// smooth instants from the polynomial through the seven nearest tags. For jitter of 3 % (rms) the largest errors are 5e-6 of
/// the amplitude at 0.05 f_s, 6e-5 at 0.1, 3e-3 at 0.2 and 6e-2 at 0.4 f_s.
///
/// A gap is a tag more than 1.5 median intervals after the one before, however long its own interval is. No bit of `usable` is
/// set in columns that have a gap or an end of the recording within the filter's reach (16 intervals of f_s to both sides);
/// their values are those of the taps that are there, or zero. O(samples), no allocation per sample.
///
/// @param recording  in any axes; the result is in the same
/// @param lag        of the recording's tags against the grid's time
/// @throws std::invalid_argument  no samples, dt not above zero, corrected times that do not increase, dt above 1000 or below
///         0.01 of the intervals
[[nodiscard]] SensorSignals resample(const record::ImuRecording& recording, const Grid& grid, const LagOfTag& lag = {});

}  // namespace coast::array
