#include "pass.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "fixing.hpp"

namespace coast::carrier {

namespace {

double interval_of(const std::vector<DifferenceEpoch>& epochs) {
  return epochs.size() < 2 ? 0.0 : (epochs.back().t - epochs.front().t) / static_cast<double>(epochs.size() - 1);
}

/// The single-point solution, as far as there is one.
PpkEpoch alone(const DifferenceEpoch& epoch) {
  PpkEpoch solved;
  solved.shown = solved.t = epoch.t;
  solved.satellites = epoch.seen;
  solved.age_s = epoch.age_s.value_or(0.0);
  solved.r_base_e = epoch.r_base_e;
  if (!epoch.alone) return solved;
  solved.t = epoch.t - epoch.alone->clock_s;
  solved.quality = record::FixQuality::kSingle;
  solved.r_e = epoch.alone->r_e;
  solved.covariance_e = epoch.alone->covariance_e;
  solved.velocity = epoch.alone->velocity;
  solved.satellites = epoch.alone->satellites;
  return solved;
}

/// Rows after adjustment to a state: what each is off against the mean of its group, which is the clock's.
void add_residuals(const DifferenceEpoch& epoch, const FloatEpoch& updated, const Eigen::VectorXd& step,
                   const FixedSolution& fixed, PpkEpoch& solved) {
  const DoubleDifferences& dd = updated.dd;
  const Eigen::VectorXd left = dd.B.transpose() * (dd.B * (dd.residual - dd.H * step));
  for (std::size_t i = 0; i < dd.rows.size(); ++i) {
    const Row& row = dd.rows[i];
    const SatelliteDifference& satellite = epoch.satellites[row.satellite];
    const bool is_fixed = row.phase && std::ranges::find(fixed.satellites, satellite.satellite) != fixed.satellites.end();
    solved.residuals.push_back({satellite.satellite, satellite.bands[row.band].band, row.phase,
                                left(static_cast<Eigen::Index>(i)) * row.sd, row.sd, row.direction,
                                is_fixed ? SignalResidual::Use::kFixed : SignalResidual::Use::kFloat});
  }
}

/// To a satellite, north, east, down, and 1 for the clock.
Eigen::Vector4d way_n(const Direction& direction) {
  const double c = std::cos(direction.elevation);
  return {c * std::cos(direction.azimuth), c * std::sin(direction.azimuth), -std::sin(direction.elevation), 1.0};
}

/// Sd of the position over that of ranges to these satellites.
double pdop(const FloatEpoch& updated) {
  std::map<std::size_t, Eigen::Vector4d> ways;
  for (const Row& row : updated.dd.rows) {
    ways[row.satellite] = way_n(row.direction);
  }
  if (ways.size() < 4) return 0.0;
  Eigen::Matrix4d N = Eigen::Matrix4d::Zero();
  for (const auto& [satellite, way] : ways) N += way * way.transpose();
  const double squared = N.inverse().topLeftCorner<3, 3>().trace();
  return squared > 0.0 ? std::sqrt(squared) : 0.0;
}

/// What the air does differently at both ends moves the position and is alike in all bands, so that no residual shows it. Where
/// it is not estimated: as one range of each satellite, 0.7 mm a kilometre off at the zenith, would move it.
Eigen::Matrix3d air_covariance(const FloatEpoch& updated, const RelativeState& state, const DifferenceEpoch& epoch,
                               const PpkOptions& options) {
  constexpr double kPerMetre = 7e-7;
  if (!options.differences.air.troposphere || (options.air && options.air->ionosphere)) return Eigen::Matrix3d::Zero();
  const double zenith = kPerMetre * (state.x.head<3>() - epoch.r_base_e).norm();
  std::map<std::size_t, Eigen::Vector4d> ways;  // with the clock
  std::map<std::size_t, double> variances;
  for (const Row& row : updated.dd.rows) {
    if (ways.contains(row.satellite)) continue;
    const double slant = zenith / std::max(std::sin(row.direction.elevation), 0.1);
    variances[row.satellite] = slant * slant;
    ways[row.satellite] = way_n(row.direction);
  }
  Eigen::Matrix4d N = Eigen::Matrix4d::Zero();
  for (const auto& [satellite, way] : ways) N += way * way.transpose() / variances.at(satellite);
  const Eigen::Matrix3d covariance_n = N.inverse().topLeftCorner<3, 3>();
  if (!covariance_n.allFinite()) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(state.x.head<3>()));
  return C_n_e * covariance_n * C_n_e.transpose();
}

PpkEpoch solve(const DifferenceEpoch& epoch, const PpkOptions& options, RelativeFilter& filter, AmbiguityFixing& fixing) {
  PpkEpoch solved = alone(epoch);
  const FloatEpoch updated = filter.step(epoch);
  solved.residuals = updated.left_out;
  solved.shortfall = updated.shortfall;
  if (!updated.updated) return solved;
  const RelativeState& state = filter.state();
  FixedSolution fixed;
  if (options.fixing.wanted) fixed = fixing.fix(epoch, updated, state);
  solved.shortfall = fixed.shortfall;
  solved.ratio = fixed.ratio;
  solved.success_rate = fixed.success_rate;
  solved.fixed_ambiguities = fixed.ambiguities;
  std::set<std::size_t> satellites;
  for (const Row& row : updated.dd.rows) satellites.insert(row.satellite);
  solved.satellites = static_cast<int>(satellites.size());
  solved.pdop = pdop(updated);
  const Eigen::VectorXd& x = fixed.fixed ? fixed.x : state.x;
  constexpr double kMostPdop = 10.0;  // beyond it errors that the noise does not count are decimetres
  if (fixed.fixed && solved.pdop > kMostPdop) solved.shortfall = Shortfall::kBadGeometry;
  const bool precise = fixed.fixed && solved.shortfall == Shortfall::kNone;
  solved.quality = precise ? record::FixQuality::kFixed : record::FixQuality::kFloat;
  solved.r_e = x.head<3>();
  solved.covariance_e = fixed.fixed ? fixed.position_covariance_e : state.P.topLeftCorner<3, 3>().eval();
  solved.covariance_e += air_covariance(updated, state, epoch, options);
  add_residuals(epoch, updated, x - (state.x - updated.step), fixed, solved);
  return solved;
}

}  // namespace

std::vector<PpkEpoch> solve_pass(const std::vector<DifferenceEpoch>& epochs, const PpkOptions& options, bool backward,
                                 const std::function<void(double)>& progress) {
  std::vector<PpkEpoch> solved(epochs.size());
  RelativeFilter filter(options, interval_of(epochs));
  AmbiguityFixing fixing(options.fixing);
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    const std::size_t i = backward ? epochs.size() - 1 - k : k;
    solved[i] = solve(epochs[i], options, filter, fixing);
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(epochs.size()));
  }
  return solved;
}

}  // namespace coast::carrier
