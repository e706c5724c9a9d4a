#pragma once
// Simulated measurements of two GNSS receivers, a rover on a moving body and a base: codes, phases, Doppler, C/N0.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "coast/record/navigation.hpp"
#include "coast/record/observation.hpp"
#include "coast/simulate/gnss.hpp"

namespace coast::simulate {

/// An obstacle that hides part of the rover's sky for a period.
struct Obstacle {
  Interval when;
  double azimuth_from = 0.0;  ///< rad from north over east; if above `azimuth_to`, the arc passes through north
  double azimuth_to = 6.283185307179586;
  double elevation = 1.0;  ///< rad: satellites below it are not tracked
};

struct ObservationOptions {
  std::vector<record::SatelliteSystem> systems{record::SatelliteSystem::kGps, record::SatelliteSystem::kGalileo};
  double rate_hz = 1.0;
  double base_rate_hz = 1.0;
  Eigen::Vector3d base_n = Eigen::Vector3d(3000.0, 1000.0, 0.0);  ///< base from the motion's origin, N, E, D, m
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();          ///< from the body's point to the antenna, m
  double elevation_mask = 0.0873;                                 ///< rad

  // One sd at the zenith; towards the horizon they grow as 1 / sin(elevation).
  double code_sd = 0.25;              ///< m, white, on every band
  double phase_sd = 0.0015;           ///< m
  double code_multipath_sd = 0.3;     ///< m, Gauss-Markov
  double phase_multipath_sd = 0.002;  ///< m
  double multipath_time = 30.0;       ///< s

  double vertical_delay = 3.0;        ///< m of ionosphere on L1 above the base
  double ionosphere_gradient = 1e-6;  ///< m of vertical delay per m towards the south
  double wet_zenith_sd = 0.003;       ///< m, rover relative to a standard atmosphere, Gauss-Markov with 1 h correlation time

  double slips_per_hour = 0.0;  ///< of each phase of the rover, of 1 to 20 cycles
  double flagged_share = 0.5;   ///< of slips that the receiver notices (loss-of-lock indicator)
  std::vector<Obstacle> obstacles;
};

/// A simulated cycle slip.
struct CycleSlip {
  geo::GpsTime t;  ///< first epoch after it
  record::Satellite satellite;
  char band = '1';
  int cycles = 0;
  bool flagged = false;
};

struct SimulatedObservations {
  record::ObservationRecording rover, base;
  record::NavigationRecording navigation;
  Eigen::Vector3d r_base_e = Eigen::Vector3d::Zero();
  std::vector<CycleSlip> slips;
};

/// Epochs at start + k / rate by the receivers' clocks, whose errors reach half a millisecond and are reset by jumps of one
/// millisecond. Orbits are the broadcast ones of a constellation of equally spaced satellites; errors of orbits and satellite
/// clocks, which are the same for both receivers, are not simulated.
///
///     P = rho + c (dt_r - dt_s) + T + I f1^2/f^2 + m + e,   Phi = rho + c (dt_r - dt_s) + T - I f1^2/f^2 + lambda (N + w) + m
///     + e
///
/// w: carrier::wind_up, of the rover's antenna with the body's attitude, the base's upright and to the north.
///
/// @throws std::invalid_argument  a rate or an sd outside its range, a system without simulated satellites
[[nodiscard]] SimulatedObservations simulate_observations(const AnalyticTrajectory& motion, geo::GpsTime start,
                                                          const ObservationOptions& options, std::uint64_t seed);

}  // namespace coast::simulate
