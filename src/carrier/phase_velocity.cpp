#include "phase_velocity.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "double_differences.hpp"

namespace coast::carrier {

namespace {

using record::FixQuality;

/// Displacement of the antenna from the previous epoch to this one.
struct Displacement {
  Eigen::Vector3d d_e = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_e = Eigen::Matrix3d::Zero();
  double dt = 0.0;
};

/// One phase at both epochs, minus the prediction of the linearisation.
struct Step {
  std::pair<record::SatelliteSystem, char> group;
  Eigen::Vector3d way_e;  ///< to the satellite
  double residual = 0.0;  ///< m
  double weight = 1.0;    ///< 1 / variance
};

/// Phases minus the model at a position, by satellite and band.
struct Observed {
  double residual = 0.0;
  double variance = 1.0;
  int arc = 0;
  Eigen::Vector3d way_e;
};
using ObservedPhases = std::map<std::pair<record::Satellite, char>, Observed>;

ObservedPhases observed(const DifferenceEpoch& epoch, const Eigen::Vector3d& r_e, const NoiseScale& noise,
                        const DifferenceOptions& options) {
  ObservedPhases all;
  const geo::Geodetic rover = geo::geodetic_from_ecef(r_e);
  for (const SatelliteDifference& s : epoch.satellites) {
    const SignalPath path = path_to(s.state, r_e, rover, epoch.t, options.air.troposphere);
    if (path.direction.elevation < options.elevation_mask) continue;
    for (const BandDifference& band : s.bands) {
      if (!band.phase) continue;
      const double sd = noise.phase * nominal_phase_sd(path.direction.elevation, s.base_elevation, band);
      all[{s.satellite, band.band}] = {*band.phase - path.modelled(s.state), sd * sd, band.arc, path.to_satellite_e};
    }
  }
  return all;
}

std::vector<Step> steps_between(const ObservedPhases& before, const ObservedPhases& now) {
  std::vector<Step> steps;
  for (const auto& [signal, at] : now) {
    const auto then = before.find(signal);
    if (then == before.end() || then->second.arc != at.arc) continue;
    steps.push_back({{signal.first.system, signal.second},
                     at.way_e,
                     at.residual - then->second.residual,
                     1.0 / (at.variance + then->second.variance)});
  }
  return steps;
}

/// Displacement from the steps, and the step that contradicts it most.
struct Adjusted {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double worst = 0.0;  ///< sd
  std::size_t which = 0;
};

/// Least squares with one clock per group, which is its weighted mean; none with too few satellites.
std::optional<Adjusted> adjust(const std::vector<Step>& steps) {
  struct Mean {
    double weight = 0.0, residual = 0.0;
    Eigen::Vector3d way_e = Eigen::Vector3d::Zero();
  };
  std::map<std::pair<record::SatelliteSystem, char>, Mean> means;
  for (const Step& s : steps) {
    Mean& mean = means[s.group];
    mean.weight += s.weight;
    mean.residual += s.weight * s.residual;
    mean.way_e += s.weight * s.way_e;
  }
  if (steps.size() < means.size() + 4) return std::nullopt;
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Step& s : steps) {
    const Mean& mean = means.at(s.group);
    const Eigen::Vector3d way_e = s.way_e - mean.way_e / mean.weight;
    N += s.weight * way_e * way_e.transpose();
    b -= s.weight * way_e * (s.residual - mean.residual / mean.weight);
  }
  Adjusted adjusted;
  adjusted.covariance = N.inverse();
  if (!adjusted.covariance.allFinite()) return std::nullopt;
  adjusted.x = adjusted.covariance * b;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Mean& mean = means.at(steps[i].group);
    const double left =
        steps[i].residual - mean.residual / mean.weight + (steps[i].way_e - mean.way_e / mean.weight).dot(adjusted.x);
    const double size = std::abs(left) * std::sqrt(steps[i].weight);
    if (size <= adjusted.worst) continue;
    adjusted.worst = size;
    adjusted.which = i;
  }
  return adjusted;
}

std::optional<Displacement> displacement(const DifferenceEpoch& before, const PpkEpoch& from, const DifferenceEpoch& now,
                                         const PpkEpoch& to, const NoiseScale& noise, const DifferenceOptions& options) {
  constexpr double kSuspicious = 4.0;  // sd
  constexpr double kLongest = 2.5;     // s
  if (from.quality == FixQuality::kUnknown || to.quality == FixQuality::kUnknown || to.t - from.t > kLongest) return {};
  std::vector<Step> steps = steps_between(observed(before, from.r_e, noise, options), observed(now, to.r_e, noise, options));
  while (const std::optional<Adjusted> adjusted = adjust(steps)) {
    if (adjusted->worst < kSuspicious)
      return Displacement{to.r_e - from.r_e + adjusted->x, adjusted->covariance, to.t - from.t};
    steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(adjusted->which));
  }
  return {};
}

using Displacements = std::vector<std::optional<Displacement>>;  // [i]: from i - 1 to i

const Displacement* at(const Displacements& steps, std::size_t i) {
  return i > 0 && i < steps.size() && steps[i] ? &*steps[i] : nullptr;
}

Eigen::Vector3d acceleration(const Displacement& before, const Displacement& after) {
  return (after.d_e / after.dt - before.d_e / before.dt) / (0.5 * (before.dt + after.dt));
}

/// The mean over two intervals is the velocity at their middle plus a 24th of jerk times span^2.
SinglePoint::Velocity central(const Displacements& steps, std::size_t i) {
  const Displacement &before = *steps[i], &after = *steps[i + 1];
  const Displacement *earlier = at(steps, i - 1), *later = at(steps, i + 2);
  const double span = before.dt + after.dt;
  const double jerk = earlier != nullptr && later != nullptr
                          ? (acceleration(after, *later) - acceleration(*earlier, before)).norm() / span
                          : 2.0 * acceleration(before, after).norm() / span;
  constexpr double kRoom = 3.0;  // the jerk of the neighbours differs from that of this interval
  const double unmodelled = kRoom * jerk * span * span / 24.0;
  SinglePoint::Velocity velocity;
  velocity.v_e = (before.d_e + after.d_e) / span;
  velocity.covariance_e = 0.5 * (before.covariance_e + after.covariance_e) / (span * span);
  velocity.covariance_e.diagonal().array() += unmodelled * unmodelled;
  return velocity;
}

/// The error of the mean over one interval is half of the velocity's change in it.
SinglePoint::Velocity one_sided(const Displacement& step, const Displacement* next) {
  constexpr double kUsual = 2.0;  // m/s^2, if the acceleration is unknown
  const double change = 0.5 * step.dt * (next != nullptr ? acceleration(step, *next).norm() : kUsual);
  SinglePoint::Velocity velocity;
  velocity.v_e = step.d_e / step.dt;
  velocity.covariance_e = step.covariance_e / (step.dt * step.dt);
  velocity.covariance_e.diagonal().array() += change * change;
  return velocity;
}

std::optional<SinglePoint::Velocity> velocity_at(const Displacements& steps, std::size_t i) {
  const Displacement *before = at(steps, i), *after = at(steps, i + 1);
  if (before != nullptr && after != nullptr) return central(steps, i);
  if (before != nullptr) return one_sided(*before, at(steps, i - 1));
  if (after != nullptr) return one_sided(*after, at(steps, i + 2));
  return {};
}

}  // namespace

void add_phase_velocities(const std::vector<DifferenceEpoch>& epochs, const NoiseScale& noise, const DifferenceOptions& options,
                          std::vector<PpkEpoch>& solved) {
  Displacements steps(epochs.size());
  for (std::size_t i = 1; i < epochs.size(); ++i)
    steps[i] = displacement(epochs[i - 1], solved[i - 1], epochs[i], solved[i], noise, options);
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    const std::optional<SinglePoint::Velocity> velocity = velocity_at(steps, i);
    if (!velocity) continue;
    if (!solved[i].velocity || velocity->covariance_e.trace() < solved[i].velocity->covariance_e.trace())
      solved[i].velocity = velocity;
  }
}

}  // namespace coast::carrier
