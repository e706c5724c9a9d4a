#pragma once
// Samples at the end of a sensor's range, found in its recording.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "coast/array/resample.hpp"
#include "coast/array/signals.hpp"
#include "coast/record/imu.hpp"

namespace coast::array {

/// Rows in the sensor's own axes.
struct Saturation {
  std::vector<std::uint8_t> samples;           ///< per sample of the recording: bit c, row c is at an end of its range
  std::array<double, kChannels> most{};        ///< the largest magnitude of the ends reached, rad/s, m/s^2; 0: none
  std::array<std::size_t, kChannels> count{};  ///< samples at an end

  [[nodiscard]] bool any() const;
};

/// Finds the ends of the range that a recording reaches. Where motion goes beyond the range, samples pile up on the largest
/// value, whatever it is: an end is a largest (or smallest) rate that at least four samples in three separate places have, and
/// three times as many as any of the five values next to it. Noise of a coarse sensor at rest repeats its extremes too, but
/// less often than what lies further in; and a channel with fewer than 100 different values is not examined.
///
/// O(N log N).
[[nodiscard]] Saturation find_saturation(const record::ImuRecording& recording);

/// Marks the columns that a resampled sensor has from samples at the end of its range, for all three axes of the kind (a
/// rotation mixes them). They are `limited` as far as the resampling filter reaches, 16 intervals to both sides: there the
/// error is a small share of what is cut off, which matters where sensors are compared, and not in what they have in common.
/// @param sensor  the recording resampled to the grid with this lag
/// @return per column: bit c is set if row c is within one interval of such a sample, and wrong; empty: none is
[[nodiscard]] std::vector<std::uint8_t> mark_saturation(SensorSignals& sensor, const Saturation& saturation,
                                                        const record::ImuRecording& recording, const Grid& grid,
                                                        const LagOfTag& lag);

/// Wrong values are not usable where another sensor has a value of the kind that is not wrong. Where none has, the mean of all
/// is what there is.
/// @param wrong  [sensor] by `mark_saturation`
void leave_out_where_others_are_not(Signals& signals, const std::vector<std::vector<std::uint8_t>>& wrong);

/// Specific forces were moved to the origin by the mean rates: where a sensor's rates are at the end of its range, the forces
/// of all are `limited`.
void mark_forces_moved_by_limited_rates(Signals& signals);

}  // namespace coast::array
