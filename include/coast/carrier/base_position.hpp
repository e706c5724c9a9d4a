#pragma once
// Where the base stands, by whatever tells it.

#include <string>

#include "coast/carrier/differences.hpp"
#include "coast/geo/reference_frame.hpp"
#include "coast/record/event.hpp"

namespace coast::carrier {

struct BaseAt {
  /// kAverage: the mean of its own single-point positions, metres off; kMoving: these, epoch by epoch; kUnstated: the header's,
  /// as nobody says anything.
  enum class How { kGiven, kHeader, kAverage, kMoving, kUnstated } how = How::kHeader;
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();  ///< marker, ECEF, m, of kGiven
  /// What the position refers to, and how fast the marker moves in it, m/year. Stated, the position is brought to ITRF2020,
  /// which today's orbits are in to centimetres, at the time of the mission; and the rover's come out there.
  struct Datum {
    geo::FrameEpoch at;
    Eigen::Vector3d velocity_mpy = Eigen::Vector3d::Zero();
  };
  std::optional<Datum> datum = std::nullopt;
};

struct KnownBase {
  BasePosition at;
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();  ///< its antenna; of the first epoch where it moves
  std::string from;                               ///< where that comes from, in words
};

/// A position of the marker, given or the header's, is carried to the antenna by the header's offset.
/// @throws InputError  no position in the header, or none that can be computed
[[nodiscard]] KnownBase known_base(const BaseAt& base_at, const record::ObservationRecording& base, const Orbits& orbits,
                                   const DifferenceOptions& options);

/// Where the base is believed to be, against its own codes: the median of single-point positions of up to 30 epochs, spread
/// over its file, free of the ionosphere where it has two bands. Their sigma is the scatter of the epochs and what codes,
/// orbits and air leave in all of them: 0.7 m horizontal and 1.5 m vertical, three times that with one band, ten times where
/// its ionosphere is not modelled. Nothing is examined of a moving base, nor where fewer than five epochs have a position.
/// @return warnings: `base_position_doubtful`, further off than 10 m and 5 sigma, of a header's position than 3 m and 2 sigma,
///         and of a header's that nobody stated in any case; `base_moves`, positions that spread by more than 30 m and 5 sigma
/// @throws InputError  a position more than 10 km off; positions that spread by more than 50 m and 5 sigma; an antenna more
/// than
///                     50 m from its marker
[[nodiscard]] record::Events examine_base(const BaseAt& base_at, const KnownBase& known,
                                          const record::ObservationRecording& base, const Orbits& orbits,
                                          const DifferenceOptions& options);

/// A rover that is said to be at rest, against its own codes, as the base in `examine_base`.
/// @return a warning `rover_moves`
/// @throws InputError  positions that spread by more than 50 m and 5 sigma
[[nodiscard]] record::Events examine_static_rover(const record::ObservationRecording& rover, const Orbits& orbits,
                                                  const DifferenceOptions& options);

/// Whether the first epoch of `a` stands in `b` to the last digit, as it does in no two receivers' files.
[[nodiscard]] bool same_observations(const record::ObservationRecording& a, const record::ObservationRecording& b);

}  // namespace coast::carrier
