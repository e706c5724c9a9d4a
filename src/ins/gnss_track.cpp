#include "gnss_track.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "coast/geo/earth.hpp"

namespace coast::ins {
namespace {

struct PolynomialFit {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  double value_gain = 1.0;  // sd of the value for observations of sd 1
  double slope_gain = 1.0;  // 1/s
};

// Polynomial of `degree` (0 to 2) in time, equal weights.
PolynomialFit fit_polynomial(const Eigen::VectorXd& times, const Eigen::MatrixX3d& values, int degree) {
  Eigen::MatrixXd design(times.size(), degree + 1);
  for (int j = 0; j <= degree; ++j) design.col(j) = times.array().pow(j);
  const Eigen::MatrixXd normal = design.transpose() * design;
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
  const Eigen::MatrixXd coefficients = solver.solve(design.transpose() * values);
  const Eigen::MatrixXd cofactor = solver.solve(Eigen::MatrixXd::Identity(degree + 1, degree + 1));
  PolynomialFit fit;
  fit.value = coefficients.row(0).transpose();
  fit.value_gain = std::sqrt(cofactor(0, 0));
  if (degree > 0) {
    fit.slope = coefficients.row(1).transpose();
    fit.slope_gain = std::sqrt(cofactor(1, 1));
  }
  return fit;
}

}  // namespace

double typical_interval(const record::GnssRecording& gnss) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < gnss.fixes.size(); ++i) intervals.push_back(gnss.fixes[i].t - gnss.fixes[i - 1].t);
  if (intervals.empty()) return 0.0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

double axis_sd(const Eigen::Matrix3d& covariance) {
  return std::sqrt(covariance.trace() / 3.0);
}

Eigen::Vector3d velocity_e(const record::GnssFix& fix) {
  return geo::C_n_e(geo::geodetic_from_ecef(fix.r_ea_e)) * fix.velocity->v_ea_n;
}

TrackPoint track_point(const record::GnssRecording& gnss, geo::GpsTime t) {
  const auto& fixes = gnss.fixes;
  const auto count = static_cast<std::ptrdiff_t>(fixes.size());
  const auto at = std::lower_bound(fixes.begin(), fixes.end(), t,
                                   [](const record::GnssFix& fix, geo::GpsTime time) { return fix.t < time; });
  std::ptrdiff_t first = at - fixes.begin();
  std::ptrdiff_t end = first;
  const auto wanted = [&](std::ptrdiff_t i) { return std::abs(fixes[static_cast<std::size_t>(i)].t - t); };
  while (end - first < count) {  // the closer neighbour is added
    const bool left = first > 0 && (end == count || wanted(first - 1) < wanted(end));
    const double distance = left ? wanted(first - 1) : wanted(end);
    if (distance > 0.5 && end - first >= 5) break;
    left ? --first : ++end;
  }

  const auto n = static_cast<Eigen::Index>(end - first);
  const Eigen::Vector3d origin = fixes[static_cast<std::size_t>(first)].r_ea_e;  // preserves the digits of the differences
  Eigen::VectorXd times(n);
  Eigen::MatrixX3d positions(n, 3), velocities(n, 3);
  bool has_velocity = true;
  double sd_position = 0.0, sd_velocity = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const record::GnssFix& fix = fixes[static_cast<std::size_t>(first + i)];
    times(i) = fix.t - t;
    positions.row(i) = (fix.r_ea_e - origin).transpose();
    sd_position = std::max(sd_position, axis_sd(fix.position_cov_n));
    has_velocity = has_velocity && fix.velocity.has_value();
    if (has_velocity) {
      velocities.row(i) = velocity_e(fix).transpose();
      sd_velocity = std::max(sd_velocity, axis_sd(fix.velocity->cov_n));
    }
  }
  const PolynomialFit position = fit_polynomial(times, positions, n > 3 ? 2 : 1);
  TrackPoint point{origin + position.value, position.slope, sd_position * position.value_gain,
                   sd_position * position.slope_gain};
  if (has_velocity && sd_velocity < point.sd_velocity) {
    const PolynomialFit velocity = fit_polynomial(times, velocities, 1);
    point.v_ea_e = velocity.value;
    point.sd_velocity = sd_velocity * velocity.value_gain;
  }
  return point;
}

}  // namespace coast::ins
