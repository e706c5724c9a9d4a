#pragma once
// Signals of several IMUs on one time grid and in one frame: the data used throughout coast::array.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"

namespace coast::array {

/// Rows of a sensor's signals: rates about x, y, z [rad/s], then specific forces along x, y, z [m/s^2].
inline constexpr int kChannels = 6;
using Channels = Eigen::Matrix<double, kChannels, 1>;

/// One IMU on the common grid, in body axes. Column n is the mean over (start + n dt, start + (n + 1) dt].
struct SensorSignals {
  std::string name;
  Eigen::Matrix<double, kChannels, Eigen::Dynamic> values;
  /// Per column: bit c is set if row c is usable (recorded, and not found defective).
  std::vector<std::uint8_t> usable;
  /// Per column: bit c is set if row c follows from samples at the end of a sensor's range, its own or, by the way to the
  /// body's origin, another's rates. Such values are not compared with those of other sensors. Empty: none.
  std::vector<std::uint8_t> limited;

  [[nodiscard]] bool may_use(int channel, std::size_t n) const { return ((usable[n] >> channel) & 1U) != 0; }
};
inline constexpr std::uint8_t kAllUsable = 0x3F;

/// All sensors have the same number of columns.
struct Signals {
  geo::GpsTime start;
  double dt = 0.0;  ///< s
  std::vector<SensorSignals> sensors;

  [[nodiscard]] std::size_t samples() const { return sensors.empty() ? 0 : sensors.front().usable.size(); }
};

}  // namespace coast::array
