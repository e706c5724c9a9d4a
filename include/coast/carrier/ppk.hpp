#pragma once
// Post-processed kinematic positions: a rover against a base by double-differenced carrier phases.

#include <string>
#include <vector>

#include "coast/carrier/differences.hpp"
#include "coast/record/event.hpp"
#include "coast/record/gnss.hpp"

namespace coast::carrier {

enum class RoverMotion { kKinematic, kStatic };

/// When ambiguities are taken as integers.
struct FixingOptions {
  bool wanted = true;
  double ratio = 3.0;           ///< least second-best over best
  double success_rate = 0.99;   ///< least, of the integers that are fixed
  double elevation_mask = 0.0;  ///< rad: below, a satellite's ambiguities stay float
  /// Integers that come out several epochs in a row become measurements of the ambiguities (fix and hold): more epochs are
  /// fixed, and a wrong fix lasts.
  bool hold = false;
};

/// How much noisier than the nominal sigmas phases and codes are. Nominal is a geodetic receiver in the open: 2 mm (1 +
/// 1/sin^2 elevation)^(1/2) and thermal noise by C/N0 of a phase, a hundred times that of a code.
struct NoiseScale {
  double phase = 1.0;
  double code = 1.0;  ///< of one epoch
  /// Multipath of a code lasts: over many epochs its average is worse by this factor than that of independent ones. The first
  /// epoch of an ambiguity counts in full, each later one as this much less sure, so that n of them tell as much of it as n of
  /// a Gauss-Markov process do.
  double code_inflation = 1.0;
  double rate = 1.0;  ///< of Doppler, against 2 cm/s at the zenith
};

/// What the air does differently above rover and base, as states beside position and ambiguities.
struct AirStates {
  bool ionosphere = false;    ///< slant delay of each satellite, of which the baseline says how large it may be
  bool zenith_delay = false;  ///< wet troposphere, rover's less base's
  bool unbounded = false;     ///< nothing is known of the slant delays beforehand: ionosphere-free
};

enum class PassOrder { kForward, kBackward, kCombined };

struct PpkOptions {
  DifferenceOptions differences;
  RoverMotion motion = RoverMotion::kKinematic;
  FixingOptions fixing;
  PassOrder order = PassOrder::kCombined;
  std::optional<AirStates> air;     ///< else by the baseline: beyond 10 km; the troposphere also beyond 150 m of height
  std::optional<NoiseScale> noise;  ///< else estimated from the residuals of a first pass
};

/// Why an epoch has not the best that there is.
enum class Shortfall {
  kNone,
  kNoBase,          ///< no epoch of the base near enough
  kNoPosition,      ///< not even a single-point position
  kFewSatellites,   ///< fewer than four that both receivers track
  kContradiction,   ///< observations contradict each other
  kFewAmbiguities,  ///< fewer than four that can be fixed
  kLowSuccessRate,  ///< the float ambiguities are too uncertain
  kLowRatio,        ///< two integer vectors are nearly as good
  kBadGeometry,     ///< integers are there, but satellites are placed too badly for centimetres
  kSeparated,       ///< forward and backward differ beyond their sigmas
};
inline constexpr int kShortfalls = 10;
/// "no epoch of the base near enough"
[[nodiscard]] std::string_view in_words(Shortfall shortfall);

/// What one phase or code was off after adjustment.
struct SignalResidual {
  record::Satellite satellite;
  char band = '1';
  bool phase = true;      ///< else code
  double residual = 0.0;  ///< m, with the float ambiguities or, where fixed, the integers
  double sd = 0.0;        ///< m, as the filter weighs it
  Direction direction;
  enum class Use : std::uint8_t { kFloat, kFixed, kLeftOut } use = Use::kFloat;
};

struct PpkEpoch {
  geo::GpsTime t;                                             ///< GPS time, the receiver's clock error taken off
  geo::GpsTime shown;                                         ///< as the receiver's clock showed it
  record::FixQuality quality = record::FixQuality::kUnknown;  ///< kFixed, kFloat, kSingle; kUnknown: no position
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();              ///< rover's antenna, ECEF, m
  Eigen::Matrix3d covariance_e = Eigen::Matrix3d::Zero();     ///< m^2
  Eigen::Vector3d r_base_e = Eigen::Vector3d::Zero();
  std::optional<SinglePoint::Velocity> velocity;
  int satellites = 0;  ///< of the double differences; of the single point where there are none
  int fixed_ambiguities = 0;
  double ratio = 0.0;
  double success_rate = 0.0;
  double age_s = 0.0;
  double pdop = 0.0;  ///< of the satellites of the double differences; 0: fewer than four
  Shortfall shortfall = Shortfall::kNone;
  /// Forward less backward, N, E, D, m, of a combined solution where both have a position of double differences.
  std::optional<Eigen::Vector3d> separation_n;
  bool both_fixed = false;  ///< forward and backward
  std::vector<SignalResidual> residuals;
};

struct PpkSolution {
  std::vector<PpkEpoch> epochs;              ///< every epoch of the rover
  std::vector<DifferenceEpoch> differences;  ///< of the same epochs, as they were used
  SignalChoice signals;
  NoiseScale noise;
  AirStates air;
  double interval_s = 0.0;  ///< of the rover, median
};

/// Every epoch that has a position, as the filter takes GNSS. Where a receiver's clock puts an epoch before the one before, it
/// is left out, with an event.
/// @param source  names it in messages
[[nodiscard]] record::GnssRecording to_fixes(const PpkSolution& solution, const std::string& source);

/// Positions of a rover. In a combined solution an epoch has the integers of either pass where the passes agree, floats are
/// weighted by their information. What differs beyond its sigmas is not averaged: the covariance spans both, and a decimetre
/// apart the epoch is float.
/// @param progress  told the share done, 0 to 1
/// @throws InputError  no common signals, no common time, no orbits
[[nodiscard]] PpkSolution solve_ppk(const record::ObservationRecording& rover, const record::ObservationRecording& base,
                                    const Orbits& orbits, const BasePosition& base_position, const PpkOptions& options,
                                    const std::function<void(double)>& progress = {});

}  // namespace coast::carrier
