#pragma once
// Missions with known truth, for tests of the carrier-phase code.

#include <Eigen/LU>

#include "coast/carrier/ppk.hpp"
#include "coast/geo/units.hpp"
#include "coast/simulate/motions.hpp"
#include "coast/simulate/observations.hpp"

namespace coast::carrier {

struct SimulatedBaseline {
  simulate::AnalyticTrajectory motion;
  geo::GpsTime start = geo::GpsTime::from_week(2374, 208800.0);
  simulate::SimulatedObservations observed;

  SimulatedBaseline(const char* kind, double duration, const simulate::ObservationOptions& options, std::uint64_t seed = 1)
      : motion(simulate::make_motion(kind, parameters(duration))),
        observed(simulate::simulate_observations(motion, start, options, seed)) {}

  [[nodiscard]] simulate::Kinematics truth(geo::GpsTime t) const {
    return motion.at(std::clamp(t - start, 0.0, motion.duration()));
  }
  [[nodiscard]] std::vector<DifferenceEpoch> differences() const {
    const DifferenceOptions options;
    const SignalChoice signals = choose_signals(observed.rover, observed.base, options.systems);
    return form_differences(
        observed.rover, observed.base, signals, BroadcastOrbits(observed.navigation),
        [this](geo::GpsTime) { return std::optional(observed.r_base_e); }, options);
  }
  [[nodiscard]] PpkSolution solve(const PpkOptions& options) const {
    const BroadcastOrbits orbits(observed.navigation);
    return solve_ppk(
        observed.rover, observed.base, orbits, [&](geo::GpsTime) { return std::optional(observed.r_base_e); }, options);
  }

 private:
  static simulate::MotionParameters parameters(double duration) {
    simulate::MotionParameters p;
    p.origin = {46.5 * geo::kDegree, 6.5 * geo::kDegree, 400.0};
    p.duration = duration;
    return p;
  }
};

/// Nothing but geometry, clocks and a mean atmosphere.
inline simulate::ObservationOptions error_free() {
  simulate::ObservationOptions options;
  options.code_sd = options.phase_sd = options.code_multipath_sd = options.phase_multipath_sd = 0.0;
  options.vertical_delay = options.ionosphere_gradient = options.wet_zenith_sd = 0.0;
  return options;
}

/// Errors of a solution against the truth.
struct Errors {
  std::size_t fixed = 0, floats = 0, single = 0, none = 0;
  std::size_t wrong = 0;                      ///< fixed, and off by more than 0.1 m
  double largest_fixed = 0.0;                 ///< m
  double fixed_nees = 0.0, float_nees = 0.0;  ///< per component, 1 where covariances hold
  double velocity_rms = 0.0;                  ///< m/s per component
};

inline Errors errors_of(const SimulatedBaseline& mission, const PpkSolution& solution) {
  Errors e;
  double velocities = 0.0;
  for (const PpkEpoch& epoch : solution.epochs) {
    const simulate::Kinematics truth = mission.truth(epoch.t);
    const Eigen::Vector3d off = epoch.r_e - truth.r_eb_e;
    const auto nees = [&] { return off.dot(epoch.covariance_e.inverse() * off) / 3.0; };
    switch (epoch.quality) {
      case record::FixQuality::kFixed:
        ++e.fixed;
        if (off.norm() > 0.1) ++e.wrong;
        e.largest_fixed = std::max(e.largest_fixed, off.norm());
        e.fixed_nees += nees();
        break;
      case record::FixQuality::kFloat:
        ++e.floats;
        e.float_nees += nees();
        break;
      case record::FixQuality::kSingle:
        ++e.single;
        break;
      default:
        ++e.none;
    }
    if (!epoch.velocity) continue;
    velocities += 1.0;
    e.velocity_rms += (epoch.velocity->v_e - truth.v_eb_e).squaredNorm() / 3.0;
  }
  if (e.fixed > 0) e.fixed_nees /= static_cast<double>(e.fixed);
  if (e.floats > 0) e.float_nees /= static_cast<double>(e.floats);
  if (velocities > 0.0) e.velocity_rms = std::sqrt(e.velocity_rms / velocities);
  return e;
}

}  // namespace coast::carrier
