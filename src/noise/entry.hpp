#pragma once
// Reading of a process's configuration entry: a value with its unit, in range, in SI.

#include <string>
#include <string_view>

#include "coast/noise/process.hpp"

namespace coast::noise {

/// The dimension of a quantity for a gyro or an accelerometer.
struct SensorDimension {
  geo::Dimension gyro;
  geo::Dimension accel;
  [[nodiscard]] geo::Dimension of(Sensor sensor) const { return sensor == Sensor::kGyro ? gyro : accel; }
};
inline constexpr SensorDimension kSignal{geo::Dimension::kAngularRate, geo::Dimension::kSpecificForce};
inline constexpr SensorDimension kSignalNoise{geo::Dimension::kAngularRateNoise, geo::Dimension::kSpecificForceNoise};
inline constexpr SensorDimension kSignalVariance{geo::Dimension::kAngularRateVariance, geo::Dimension::kSpecificForceVariance};
inline constexpr SensorDimension kSignalWalk{geo::Dimension::kAngularRateWalk, geo::Dimension::kSpecificForceWalk};
inline constexpr SensorDimension kSignalRamp{geo::Dimension::kAngularRateRamp, geo::Dimension::kSpecificForceRamp};
inline constexpr SensorDimension kSignalIntegral{geo::Dimension::kAngle, geo::Dimension::kVelocity};
inline constexpr SensorDimension kDimensionless{geo::Dimension::kRatio, geo::Dimension::kRatio};
inline constexpr SensorDimension kSmallAngle{geo::Dimension::kAngle, geo::Dimension::kAngle};

/// Reads `key` with the entry's `unit`.  @return SI value, >= 0
[[nodiscard]] double value_with_unit(const config::Node& entry, std::string_view key, const SensorDimension& dimension,
                                     const EntryContext& context);
/// The same for a value that may be negative.
[[nodiscard]] double signed_value_with_unit(const config::Node& entry, std::string_view key, const SensorDimension& dimension,
                                            const EntryContext& context);
/// The SI unit's name of a dimension, for writing an entry.
[[nodiscard]] std::string_view si_unit(geo::Dimension dimension);

}  // namespace coast::noise
