#include "force_observations.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/geo/earth.hpp"
#include "gnss_track.hpp"

namespace coast::ins {
namespace {

constexpr double kWantedNoise = 0.05;  // m/s^2, of an observed mean acceleration if the span can be chosen

// The inertial frame has the e-frame axes of the reference time.
Eigen::Matrix3d C_e_i(double seconds) {
  return Eigen::AngleAxisd(geo::kEarthRate * seconds, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

struct Fixes {
  std::vector<double> t;  // s since the reference
  std::vector<Eigen::Vector3d> r_i;
  std::vector<const record::GnssFix*> fix;
};

Fixes fixes_between(const record::GnssRecording& gnss, geo::GpsTime reference, geo::GpsTime end) {
  Fixes fixes;
  for (const record::GnssFix& fix : gnss.fixes) {
    if (fix.t < reference || fix.t > end) continue;
    fixes.t.push_back(fix.t - reference);
    fixes.r_i.emplace_back(C_e_i(fixes.t.back()) * fix.r_ea_e);
    fixes.fix.push_back(&fix);
  }
  return fixes;
}

double median_sd(const Fixes& fixes, bool velocity) {
  std::vector<double> sds;
  for (const record::GnssFix* fix : fixes.fix) {
    if (velocity && !fix->velocity) return std::numeric_limits<double>::infinity();
    sds.push_back(axis_sd(velocity ? fix->velocity->cov_n : fix->position_cov_n));
  }
  std::nth_element(sds.begin(), sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 2), sds.end());
  return sds[sds.size() / 2];
}

// gamma = g + omega_ie x (omega_ie x r): gravitation only, as required in an inertial frame.
Eigen::Vector3d gravitation_i(const record::GnssFix& fix, double t) {
  const Eigen::Vector3d& r = fix.r_ea_e;
  const Eigen::Vector3d centrifugal(geo::kEarthRate * geo::kEarthRate * r.x(), geo::kEarthRate * geo::kEarthRate * r.y(), 0.0);
  return C_e_i(t) * (geo::gravity_e(r) - centrifugal);
}

Eigen::Vector3d velocity_i(const Fixes& fixes, std::size_t k) {
  const Eigen::Vector3d& r = fixes.fix[k]->r_ea_e;
  const Eigen::Vector3d v_ib_e = velocity_e(*fixes.fix[k]) + geo::kEarthRate * Eigen::Vector3d(-r.y(), r.x(), 0.0);
  return C_e_i(fixes.t[k]) * v_ib_e;
}

ForceObservation hat_observation(const Fixes& fixes, std::size_t a, std::size_t k, std::size_t b) {
  const double before = fixes.t[k] - fixes.t[a], after = fixes.t[b] - fixes.t[k], span = 0.5 * (before + after);
  const Eigen::Vector3d mean = ((fixes.r_i[b] - fixes.r_i[k]) / after - (fixes.r_i[k] - fixes.r_i[a]) / before) / span;
  const auto variance = [&](std::size_t j, double weight) {
    return weight * weight * fixes.fix[j]->position_cov_n.trace() / 3.0;
  };
  ForceObservation o{fixes.t[a], fixes.t[k], fixes.t[b], true, mean - gravitation_i(*fixes.fix[k], fixes.t[k]), 0.0, {}, 0.0};
  o.variance = (variance(a, 1.0 / before) + variance(k, 1.0 / before + 1.0 / after) + variance(b, 1.0 / after)) / (span * span);
  o.velocity_i = C_e_i(o.t_k) * (fixes.fix[b]->r_ea_e - fixes.fix[a]->r_ea_e) / (before + after);
  o.velocity_sd = std::sqrt(variance(a, 1.0) + variance(b, 1.0)) / (before + after);
  return o;
}

ForceObservation box_observation(const Fixes& fixes, std::size_t a, std::size_t b) {
  const double span = fixes.t[b] - fixes.t[a];
  const std::size_t k = (a + b) / 2;
  ForceObservation o{fixes.t[a], fixes.t[k], fixes.t[b], false, {}, 0.0, {}, 0.0};
  o.force_i = (velocity_i(fixes, b) - velocity_i(fixes, a)) / span - gravitation_i(*fixes.fix[k], 0.5 * (o.t_a + o.t_b));
  o.variance = (fixes.fix[a]->velocity->cov_n.trace() + fixes.fix[b]->velocity->cov_n.trace()) / (3.0 * span * span);
  o.velocity_i = C_e_i(o.t_k) * 0.5 * (velocity_e(*fixes.fix[a]) + velocity_e(*fixes.fix[b]));
  o.velocity_sd = 0.5 * span * std::sqrt(o.variance);
  return o;
}

// First index at or after `from` whose time is at least t.
std::size_t index_at(const Fixes& fixes, std::size_t from, double t) {
  while (from < fixes.t.size() && fixes.t[from] < t - 1e-3) ++from;
  return from;
}

}  // namespace

std::vector<ForceObservation> observe_specific_force(const record::GnssRecording& gnss, geo::GpsTime reference,
                                                     geo::GpsTime end) {
  const Fixes fixes = fixes_between(gnss, reference, end);
  std::vector<ForceObservation> observations;
  if (fixes.t.size() < 3) return observations;
  const double sd = median_sd(fixes, false), sd_velocity = median_sd(fixes, true);
  const double span = std::clamp(std::sqrt(std::sqrt(6.0) * sd / kWantedNoise), 1.0, 10.0);
  const double span_velocity = std::clamp(std::sqrt(2.0) * sd_velocity / kWantedNoise, 1.0, 10.0);
  const bool hat = std::sqrt(6.0) * sd / (span * span) <= std::sqrt(2.0) * sd_velocity / span_velocity;
  const double step = std::max(hat ? span : span_velocity, typical_interval(gnss));
  for (std::size_t a = 0; a < fixes.t.size();) {
    const std::size_t k = index_at(fixes, a + 1, fixes.t[a] + step);
    const std::size_t b = hat ? index_at(fixes, k + 1, fixes.t[a] + 2.0 * step) : k;
    if (b >= fixes.t.size()) break;
    const bool gap = fixes.t[b] - fixes.t[a] > (hat ? 3.0 : 1.5) * step + 2.0;
    if (!gap) observations.push_back(hat ? hat_observation(fixes, a, k, b) : box_observation(fixes, a, b));
    a = k;
  }
  return observations;
}

}  // namespace coast::ins
