#pragma once
// Scale and delay of an odometer from the distances between fixes; private to the room.

#include <optional>
#include <vector>

#include "coast/record/aid.hpp"
#include "coast/record/gnss.hpp"

namespace coast::estimate {

inline constexpr double kLongestOdometerGap = 1.5;  ///< s between rows; over longer ones no distance is known

/// Distance travelled over time, in units of the odometer.
struct TravelledDistance {
  std::vector<geo::GpsTime> t;
  std::vector<double> distance;
  std::vector<std::size_t> bridged;  ///< number of gaps up to each time
  /// Between two instants; nothing if they are not within the rows, or a gap lies between them.
  [[nodiscard]] std::optional<double> between(geo::GpsTime from, geo::GpsTime to) const;
};
[[nodiscard]] TravelledDistance distance_by_speed(const record::AidRecording& rows);
/// A count that falls was reset: a gap.
[[nodiscard]] TravelledDistance distance_by_count(const record::AidRecording& rows);

struct OdometerFit {
  bool seen = false;     ///< there were enough fixes in motion
  double scale = 1.0;    ///< true distance over that of the odometer
  double delay_s = 0.0;  ///< a row tagged t is of t - delay
  std::size_t stretches = 0;
  /// Median difference of the chords from the odometer's distances beyond the noise of the fixes, relative to the chords.
  double misfit = 0.0;
  double spread = 0.0;  ///< median difference of the chords from their median, relative to it: the misfit of a constant
};
/// The scale is the median ratio of chords between fixes to the odometer's distances, the delay that for which they differ
/// least (mean squares, each limited, so that gross errors of fixes and slip do not matter), within half a minute.
/// @param scale, delay_s  where stated, these are kept
[[nodiscard]] OdometerFit fit_odometer(const TravelledDistance& distance, const record::GnssRecording& gnss,
                                       std::optional<double> scale, std::optional<double> delay_s);

}  // namespace coast::estimate
