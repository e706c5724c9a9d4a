#pragma once
// Where the base stands, by whatever tells it.

#include <string>

#include "coast/carrier/differences.hpp"
#include "coast/geo/reference_frame.hpp"

namespace coast::carrier {

struct BaseAt {
  /// kAverage: the mean of its own single-point positions, metres off; kMoving: these, epoch by epoch.
  enum class How { kGiven, kHeader, kAverage, kMoving } how = How::kHeader;
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

}  // namespace coast::carrier
