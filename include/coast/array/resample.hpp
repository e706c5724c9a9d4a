#pragma once
// Resampling of one IMU's recording to the array's common time grid.

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

/// A lag that is linear in the tag. A sample tagged t was measured at t - at(t).
struct LinearLag {
  geo::GpsTime epoch;
  double offset_s = 0.0;   ///< at the epoch
  double drift_ppm = 0.0;  ///< positive: the device's clock runs fast

  [[nodiscard]] double at(geo::GpsTime tag) const { return offset_s + 1e-6 * drift_ppm * (tag - epoch); }
  [[nodiscard]] double operator()(geo::GpsTime tag) const { return at(tag); }
};

/// Lag [s] of a tag; empty: none.
using LagOfTag = std::function<double(geo::GpsTime)>;

/// Means of rates and specific forces on a grid, from increments over (t - dt, t] on the device's own clock.
///
/// The mean rates, increment over true interval, are interpolated by a sinc with a Kaiser window of 32 taps. Input and output
/// are means, over T and over dt, so the kernel's spectrum is that of the low-pass times sinc(f dt)/sinc(f T): it converts
/// means of one length to means of another, and with dt = T is a plain interpolation. Its weights are normalised: a constant
/// rate is reproduced exactly, and angles add up. On a coarser grid the low-pass is that of the grid and the number of taps
/// increases in proportion. With f_s the lower of both sampling frequencies, amplitudes are correct to 3e-5 up to 0.4 f_s (0.8
/// of the Nyquist frequency); higher frequencies are attenuated, to 3e-5 above 0.6 f_s.
///
/// Times are the corrected tags. Slowly changing intervals (clock drift) are followed exactly. Tags that jitter about a smooth
/// clock (a moving mean over 65 tags, applied twice) are treated as true times: the cumulative increments are first
/// interpolated at the smooth times by the polynomial through the seven nearest tags. For jitter of 3 % (rms) the largest
/// errors are 5e-6 of the amplitude at 0.05 f_s, 6e-5 at 0.1, 3e-3 at 0.2 and 6e-2 at 0.4 f_s.
///
/// A gap is a tag more than 1.5 median intervals after the previous one, whatever the sample's own interval. No bit of `usable`
/// is set in columns that have a gap or an end of the recording within the filter's reach (16 intervals of f_s to both sides);
/// their values use the available taps only, or are zero. O(samples), no allocation per sample.
///
/// @param recording  in any axes; the result is in the same
/// @param lag        of the recording's tags relative to the grid's time
/// @throws std::invalid_argument  no samples, dt not above zero, corrected times that do not increase, dt above 1000 or below
///         0.01 of the intervals
[[nodiscard]] SensorSignals resample(const record::ImuRecording& recording, const Grid& grid, const LagOfTag& lag = {});

}  // namespace coast::array
