#pragma once
// Position of the base station, from one of several sources.

#include <string>

#include "coast/carrier/differences.hpp"
#include "coast/geo/reference_frame.hpp"
#include "coast/record/event.hpp"

namespace coast::carrier {

struct BaseAt {
  /// kAverage: the mean of its own single-point positions, with an error of metres; kMoving: these, epoch by epoch; kUnstated:
  /// that of the header, because none is configured.
  enum class How { kGiven, kHeader, kAverage, kMoving, kUnstated } how = How::kHeader;
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();  ///< marker, ECEF, m, of kGiven
  /// Frame and epoch of the position, and the marker's velocity in that frame, m/year. If given, the position is transformed to
  /// ITRF2020 (the frame of current orbits, to centimetres) at the time of the mission, and the rover's positions are then in
  /// that frame.
  struct Datum {
    geo::FrameEpoch at;
    Eigen::Vector3d velocity_mpy = Eigen::Vector3d::Zero();
  };
  std::optional<Datum> datum = std::nullopt;
};

struct KnownBase {
  BasePosition at;
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();  ///< its antenna; if it moves, at the first epoch
  std::string from;                               ///< source of the position, in words
};

/// A marker position, given or from the header, is reduced to the antenna with the header's offset.
/// @throws InputError  no position in the header, or none that can be computed
[[nodiscard]] KnownBase known_base(const BaseAt& base_at, const record::ObservationRecording& base, const Orbits& orbits,
                                   const DifferenceOptions& options);

/// Checks the position of the base against its own codes: the median of single-point positions of up to 30 epochs over its
/// file, ionosphere-free if it has two bands. Their sigma combines the scatter of the epochs and the common error of codes,
/// orbits and atmosphere: 0.7 m horizontal and 1.5 m vertical, three times that with one band, ten times if the ionosphere is
/// not modelled. A moving base, or one with fewer than five positions, is not checked.
/// @return warnings: `base_position_doubtful`, difference above 10 m and 5 sigma, for a header position above 3 m and 2 sigma,
///         and for kUnstated in any case; `base_moves`, scatter of the positions above 30 m and 5 sigma
/// @throws InputError  a difference above 10 km; a scatter of the positions above 50 m and 5 sigma; an antenna more than 50 m
///                     from its marker
[[nodiscard]] record::Events examine_base(const BaseAt& base_at, const KnownBase& known,
                                          const record::ObservationRecording& base, const Orbits& orbits,
                                          const DifferenceOptions& options);

/// Checks a rover configured as static against its own codes, like the base in `examine_base`.
/// @return a warning `rover_moves`
/// @throws InputError  scatter of the positions above 50 m and 5 sigma
[[nodiscard]] record::Events examine_static_rover(const record::ObservationRecording& rover, const Orbits& orbits,
                                                  const DifferenceOptions& options);

/// Whether the first epoch of `a` occurs identically in `b`: two different receivers never give this.
[[nodiscard]] bool same_observations(const record::ObservationRecording& a, const record::ObservationRecording& b);

}  // namespace coast::carrier
