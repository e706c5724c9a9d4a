#pragma once
// Time reversal: a mission in the mirrored time t' = 2 mirror - t. The navigation equations keep their form if velocities, body
// rates and the Earth's rate change sign; specific force, gravity, positions and attitudes are unchanged.

#include "coast/geo/time.hpp"
#include "coast/ins/strapdown.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::ins {

/// 2 mirror - t, exact to the nanosecond; its own inverse.
[[nodiscard]] constexpr geo::GpsTime mirrored(geo::GpsTime t, geo::GpsTime mirror) {
  return geo::GpsTime::from_nanoseconds(2 * mirror.nanoseconds() - t.nanoseconds());
}

/// The time-reversed interval: rotation exp(-phi), and u resolved at the interval's end, which is now its start.
[[nodiscard]] BodyIncrement reversed(const BodyIncrement& increment);

/// Velocity negated, time mirrored. Continue with `Strapdown(reversed(state, mirror), -kEarthRate)`.
[[nodiscard]] record::NavState reversed(const record::NavState& state, geo::GpsTime mirror);

/// Meaning of (dtheta, dv) in a recording: integrals in moving body axes as output by the sensor, or (phi, u) of a
/// `BodyIncrement` as computed by `compensate_chebyshev`.
enum class IncrementKind { kRaw, kCompensated };

/// Reverses a recording in place: order, time tags (the tag of a sample is again the end of its interval, the mirrored start),
/// sign of rotation. Temperatures and noise levels are reversed too; times of events stay those of the original. Reversing
/// twice restores it.
/// @note time tags come from the intervals' starts, t - dt rounded to 1 ns, and stay strictly increasing.
void reverse(record::ImuRecording& recording, geo::GpsTime mirror, IncrementKind kind = IncrementKind::kRaw);

/// Reverses a GNSS recording in place: order, times, velocities.
void reverse(record::GnssRecording& recording, geo::GpsTime mirror);

}  // namespace coast::ins
