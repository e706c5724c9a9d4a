#pragma once
// Post-processed kinematic positions: a rover relative to a base by double-differenced carrier phases.

#include <string>
#include <vector>

#include "coast/carrier/differences.hpp"
#include "coast/record/event.hpp"
#include "coast/record/gnss.hpp"

namespace coast::carrier {

enum class RoverMotion { kKinematic, kStatic };

/// Conditions for fixing ambiguities to integers.
struct FixingOptions {
  bool wanted = true;
  double ratio = 3.0;           ///< minimum of second-best over best
  double success_rate = 0.99;   ///< minimum, for the integers that are fixed
  double elevation_mask = 0.0;  ///< rad: below, a satellite's ambiguities stay float
  /// Integers that are the same for several epochs in a row become measurements of the ambiguities (fix and hold): more epochs
  /// are fixed, but a wrong fix persists.
  bool hold = false;
};

/// Factors on the nominal sigmas of phases and codes. Nominal is a geodetic receiver with open sky: 2 mm (1 + 1/sin^2
/// elevation)^(1/2) and thermal noise by C/N0 for a phase, a hundred times that for a code.
struct NoiseScale {
  double phase = 1.0;
  double code = 1.0;  ///< of one epoch
  /// Code multipath is time-correlated: the error of an average over many epochs is larger by this factor than with independent
  /// errors. The first epoch of an ambiguity has full weight, each later one a sigma larger by this factor, so that n epochs
  /// give as much information as n epochs of a Gauss-Markov process.
  double code_inflation = 1.0;
  double rate = 1.0;  ///< of Doppler, relative to 2 cm/s at the zenith
  /// Of the displacement between two epochs by Doppler, relative to its formal sd; absent: not used.
  std::optional<double> displacement = {};
};

/// Differential atmospheric delays of rover and base, as states in addition to position and ambiguities.
struct AirStates {
  bool ionosphere = false;    ///< slant delay of each satellite, with a prior sigma by the baseline length
  bool zenith_delay = false;  ///< wet troposphere, rover minus base
  bool unbounded = false;     ///< no prior for the slant delays: ionosphere-free
};

enum class PassOrder { kForward, kBackward, kCombined };

struct PpkOptions {
  DifferenceOptions differences;
  RoverMotion motion = RoverMotion::kKinematic;
  FixingOptions fixing;
  PassOrder order = PassOrder::kCombined;
  std::optional<AirStates> air;     ///< absent: on for baselines above 10 km; troposphere also above 150 m of height
  std::optional<NoiseScale> noise;  ///< absent: estimated from the residuals of a first pass
};

/// Why an epoch does not have the best possible solution.
enum class Shortfall {
  kNone,
  kNoBase,          ///< no epoch of the base near enough
  kNoPosition,      ///< not even a single-point position
  kFewSatellites,   ///< fewer than four that both receivers track
  kContradiction,   ///< observations contradict each other
  kFewAmbiguities,  ///< fewer than four that can be fixed
  kLowSuccessRate,  ///< the float ambiguities are too uncertain
  kLowRatio,        ///< two integer vectors are nearly as good
  kBadGeometry,     ///< integers are fixed, but the geometry is too weak for centimetres
  kSeparated,       ///< forward and backward differ beyond their sigmas
};
inline constexpr int kShortfalls = 10;
/// "no epoch of the base near enough"
[[nodiscard]] std::string_view in_words(Shortfall shortfall);

/// Residual of one phase or code after adjustment.
struct SignalResidual {
  record::Satellite satellite;
  char band = '1';
  bool phase = true;      ///< else code
  double residual = 0.0;  ///< m, with the float ambiguities or, if fixed, the integers
  double sd = 0.0;        ///< m, as used by the filter
  Direction direction;
  enum class Use : std::uint8_t { kFloat, kFixed, kLeftOut } use = Use::kFloat;
};

struct PpkEpoch {
  geo::GpsTime t;                                             ///< GPS time, corrected for the receiver clock error
  geo::GpsTime shown;                                         ///< by the receiver's clock
  record::FixQuality quality = record::FixQuality::kUnknown;  ///< kFixed, kFloat, kSingle; kUnknown: no position
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();              ///< rover's antenna, ECEF, m
  Eigen::Matrix3d covariance_e = Eigen::Matrix3d::Zero();     ///< m^2
  Eigen::Vector3d r_base_e = Eigen::Vector3d::Zero();
  std::optional<SinglePoint::Velocity> velocity;
  int satellites = 0;  ///< of the double differences; of the single point if there are none
  int fixed_ambiguities = 0;
  int known_ambiguities = 0;  ///< of these, with the integer that the majority of all epochs of their arc has
  double ratio = 0.0;
  double success_rate = 0.0;
  double age_s = 0.0;
  double pdop = 0.0;  ///< of the satellites of the double differences; 0: fewer than four
  Shortfall shortfall = Shortfall::kNone;
  /// Forward minus backward, N, E, D, m, for a combined solution if both have a double-difference position.
  std::optional<Eigen::Vector3d> separation_n;
  bool both_fixed = false;  ///< forward and backward
  std::vector<SignalResidual> residuals;
};

struct PpkSolution {
  std::vector<PpkEpoch> epochs;              ///< every epoch of the rover
  std::vector<DifferenceEpoch> differences;  ///< of the same epochs, as used
  SignalChoice signals;
  NoiseScale noise;
  AirStates air;
  double interval_s = 0.0;  ///< of the rover, median
};

/// Every epoch that has a position, as GNSS input of the filter. An epoch that is not later than the previous one, by the
/// receiver's clock, is left out, with an event.
/// @param source  names it in messages
[[nodiscard]] record::GnssRecording to_fixes(const PpkSolution& solution, const std::string& source);

/// Positions of a rover. In a combined solution an epoch has the integers of either pass if the passes agree; float solutions
/// are weighted by their information. Solutions that differ beyond their sigmas are not averaged: the covariance covers both,
/// and if they differ by a decimetre the epoch is float.
/// @param progress  called with the fraction done, 0 to 1
/// @throws InputError  no common signals, no common time, no orbits
[[nodiscard]] PpkSolution solve_ppk(const record::ObservationRecording& rover, const record::ObservationRecording& base,
                                    const Orbits& orbits, const BasePosition& base_position, const PpkOptions& options,
                                    const std::function<void(double)>& progress = {});

}  // namespace coast::carrier
