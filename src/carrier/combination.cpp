#include <Eigen/LU>

#include "coast/geo/earth.hpp"
#include "pass.hpp"

namespace coast::carrier {

namespace {

using record::FixQuality;

bool has_baseline(const PpkEpoch& epoch) {
  return epoch.quality == FixQuality::kFixed || epoch.quality == FixQuality::kFloat;
}

/// The three components within 99.9 %.
bool agree(const Eigen::Vector3d& difference, const Eigen::Matrix3d& covariance) {
  constexpr double kChiSquare = 16.27;
  constexpr double kAlways = 0.005;  // m: both have the noise of the epoch in common, which the sum of covariances has twice
  return difference.norm() < kAlways || difference.dot(covariance.inverse() * difference) < kChiSquare;
}

/// The passes contradict each other, and it is unknown which is right: the covariance covers both. If a decimetre apart they
/// cannot both have the right integers.
PpkEpoch separated(PpkEpoch likelier, const Eigen::Vector3d& difference) {
  constexpr double kDecimetre = 0.1;
  likelier.covariance_e += difference * difference.transpose();
  if (difference.norm() < kDecimetre) return likelier;
  likelier.quality = FixQuality::kFloat;
  likelier.shortfall = Shortfall::kSeparated;
  return likelier;
}

PpkEpoch weighted(const PpkEpoch& f, const PpkEpoch& b) {
  PpkEpoch both = f.covariance_e.trace() < b.covariance_e.trace() ? f : b;
  const Eigen::Matrix3d information_f = f.covariance_e.inverse(), information_b = b.covariance_e.inverse();
  both.covariance_e = (information_f + information_b).inverse();
  both.r_e = both.covariance_e * (information_f * f.r_e + information_b * b.r_e);
  return both;
}

/// Integers that most epochs of their arcs agree on, and that this epoch confirms: a float solution that contradicts them has
/// taken a reflection for a signal. Where the two contradicted each other in simulated streets, the fix was right in 98 % of
/// the epochs within these bounds, and in six of ten outside.
bool confirmed(const PpkEpoch& epoch) {
  constexpr int kEnough = 9;
  constexpr double kRatio = 20.0;
  return epoch.quality == FixQuality::kFixed && epoch.known_ambiguities >= kEnough && epoch.ratio >= kRatio;
}

PpkEpoch combine(const PpkEpoch& f, const PpkEpoch& b) {
  if (!has_baseline(f) || !has_baseline(b)) return has_baseline(b) ? b : f;
  const Eigen::Vector3d difference = f.r_e - b.r_e;
  const bool f_fixed = f.quality == FixQuality::kFixed, b_fixed = b.quality == FixQuality::kFixed;
  const PpkEpoch& likelier = f_fixed != b_fixed ? (f_fixed ? f : b)
                             : f_fixed          ? (f.fixed_ambiguities >= b.fixed_ambiguities ? f : b)
                                                : (f.covariance_e.trace() < b.covariance_e.trace() ? f : b);
  PpkEpoch both;
  // Multipath makes float errors temporarily twice their sigmas: they contradict a fix only beyond that.
  constexpr double kFloatVariance = 4.0;
  const double doubt_f = f_fixed || !b_fixed ? 1.0 : kFloatVariance, doubt_b = b_fixed || !f_fixed ? 1.0 : kFloatVariance;
  const bool settled = f_fixed != b_fixed && confirmed(likelier);
  if (!settled && !agree(difference, doubt_f * f.covariance_e + doubt_b * b.covariance_e))
    both = separated(likelier, difference);
  else
    both = f_fixed || b_fixed ? likelier : weighted(f, b);
  both.separation_n = geo::C_n_e(geo::geodetic_from_ecef(both.r_e)).transpose() * difference;
  both.both_fixed = f_fixed && b_fixed;
  return both;
}

}  // namespace

std::vector<PpkEpoch> combine(const std::vector<PpkEpoch>& forward, const std::vector<PpkEpoch>& backward) {
  std::vector<PpkEpoch> both;
  both.reserve(forward.size());
  for (std::size_t i = 0; i < forward.size(); ++i) both.push_back(combine(forward[i], backward[i]));
  return both;
}

}  // namespace coast::carrier
