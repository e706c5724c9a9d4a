#pragma once
// A mission run backwards; private to the room.

#include "coast/estimate/forward_filter.hpp"
#include "coast/ins/reversal.hpp"

namespace coast::study {

/// View of a mission with time reversed about `mirror`.
class ReversedRun {
 public:
  struct AlreadyReversed {};
  ReversedRun(const ReversedRun&) = delete;
  ReversedRun& operator=(const ReversedRun&) = delete;
  /// Reverses the recordings in place; they must outlive the run.
  ReversedRun(const estimate::Mission& forward, record::ImuRecording& imu, record::GnssRecording& gnss, geo::GpsTime mirror)
      : ReversedRun(forward, (ins::reverse(imu, mirror, forward.increments), imu), (ins::reverse(gnss, mirror), gnss), mirror,
                    AlreadyReversed{}) {}
  ReversedRun(const estimate::Mission& forward, const record::ImuRecording& imu, const record::GnssRecording& gnss,
              geo::GpsTime mirror, AlreadyReversed);

  [[nodiscard]] const estimate::Mission& mission() const { return mission_; }
  /// Into reversed time and back (its own inverse): velocity, additive gyro errors, rates of change and
  /// time offset change sign.
  [[nodiscard]] estimate::FilterState mirrored(const estimate::FilterState& state, const estimate::StateLayout& layout) const;

  /// The same fixes withheld, knots at the same instants.
  [[nodiscard]] estimate::FilterOptions mirrored(estimate::FilterOptions options) const;

 private:
  geo::GpsTime mirror_;
  estimate::Mission mission_;
  std::optional<estimate::CarrierObservations> carrier_;
};

}  // namespace coast::study
