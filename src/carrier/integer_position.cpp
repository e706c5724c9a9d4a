#include "integer_position.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace coast::carrier {

namespace {

using Kind = Unknown::Kind;
using record::SatelliteSystem;

/// Integer phases as rows over the position, the ambiguity of each group's reference (with the clock), and the atmosphere.
struct IntegerRows {
  std::vector<Unknown> ambiguities;   ///< of the rows
  std::vector<Eigen::Vector3d> ways;  ///< directions to the satellites, e
  Eigen::MatrixXd A;
  Eigen::VectorXd y;
  std::vector<Eigen::Index> air;  ///< states, in the order of the last columns
  Eigen::MatrixXd prior;          ///< information about them
  Eigen::VectorXd prior_step;
};

std::map<Unknown, double> values_of(const std::vector<FixedPair>& pairs) {
  std::map<Unknown, double> values;
  for (const FixedPair& p : pairs) {
    values.emplace(p.reference, 0.0);
    values[p.ambiguity] = p.integer;
  }
  return values;
}

std::vector<Eigen::Index> air_indices(const RelativeState& state) {
  std::vector<Eigen::Index> air;
  for (Eigen::Index i = 3; i < state.size(); ++i) {
    const Kind kind = state.unknowns()[static_cast<std::size_t>(i)].kind;
    if (kind == Kind::kZenithDelay || kind == Kind::kIonosphere) air.push_back(i);
  }
  return air;
}

IntegerRows integer_rows(const DifferenceEpoch& epoch, const FloatEpoch& updated, const RelativeState& state,
                         const FixedSolution& fixed) {
  struct Used {
    Eigen::Index row, ambiguity;
    double value;
    std::pair<SatelliteSystem, char> group;
  };
  const std::map<Unknown, double> values = values_of(fixed.pairs);
  IntegerRows p;
  std::vector<Used> used;
  std::map<std::pair<SatelliteSystem, char>, Eigen::Index> groups;
  for (std::size_t i = 0; i < updated.dd.rows.size(); ++i) {
    const Row& row = updated.dd.rows[i];
    const SatelliteDifference& satellite = epoch.satellites[row.satellite];
    if (row.observable != Observable::kPhase || satellite.satellite.system == SatelliteSystem::kGlonass) continue;
    const BandDifference& band = satellite.bands[row.band];
    const Unknown ambiguity{Kind::kAmbiguity, satellite.satellite, band.band, band.arc};
    const auto value = values.find(ambiguity);
    if (value == values.end()) continue;
    const auto at = static_cast<Eigen::Index>(i);
    used.push_back({at, state.index(ambiguity), value->second, {satellite.satellite.system, band.band}});
    groups.try_emplace(used.back().group, 3 + static_cast<Eigen::Index>(groups.size()));
    p.ambiguities.push_back(ambiguity);
    p.ways.emplace_back(-row.sd * updated.dd.H.row(at).head<3>().transpose());
  }
  p.air = air_indices(state);
  const auto n = static_cast<Eigen::Index>(used.size()), g = static_cast<Eigen::Index>(groups.size()),
             a = static_cast<Eigen::Index>(p.air.size());
  const Eigen::VectorXd before = state.x - updated.step;
  p.A.setZero(n, 3 + g + a);
  p.y.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Used& u = used[static_cast<std::size_t>(k)];
    const double per_cycle = updated.dd.H(u.row, u.ambiguity);
    p.A.row(k).head<3>() = updated.dd.H.row(u.row).head<3>();
    p.A(k, groups.at(u.group)) = per_cycle;
    for (Eigen::Index j = 0; j < a; ++j) p.A(k, 3 + g + j) = updated.dd.H(u.row, p.air[static_cast<std::size_t>(j)]);
    p.y(k) = updated.dd.residual(u.row) - per_cycle * (u.value - before(u.ambiguity));
  }
  if (a > 0) {
    p.prior = Eigen::MatrixXd(fixed.P(p.air, p.air)).ldlt().solve(Eigen::MatrixXd::Identity(a, a));
    p.prior_step = (fixed.x - before)(p.air);
  }
  return p;
}

struct IntegerAdjustment {
  Eigen::VectorXd u;
  Eigen::MatrixXd covariance;
  std::optional<Eigen::Index> outlier;
};

std::optional<IntegerAdjustment> adjust_integers(const IntegerRows& p, const std::vector<bool>& left_out) {
  constexpr double kSuspicious = 4.5;   // sd
  constexpr double kControlled = 0.01;  // of a variance of one
  Eigen::MatrixXd A = p.A;
  Eigen::VectorXd y = p.y;
  for (std::size_t k = 0; k < left_out.size(); ++k)
    if (left_out[k]) {
      A.row(static_cast<Eigen::Index>(k)).setZero();
      y(static_cast<Eigen::Index>(k)) = 0.0;
    }
  Eigen::MatrixXd N = A.transpose() * A;
  Eigen::VectorXd b = A.transpose() * y;
  if (!p.air.empty()) {
    const auto a = static_cast<Eigen::Index>(p.air.size());
    N.bottomRightCorner(a, a) += p.prior;
    b.tail(a) += p.prior * p.prior_step;
  }
  for (Eigen::Index i = 3; i < N.rows(); ++i)
    if (N(i, i) == 0.0) N(i, i) = 1.0;  // a group without rows
  const Eigen::LDLT<Eigen::MatrixXd> normal(N);
  IntegerAdjustment adjusted;
  adjusted.u = normal.solve(b);
  adjusted.covariance = normal.solve(Eigen::MatrixXd::Identity(N.rows(), N.cols()));
  if (normal.info() != Eigen::Success || !adjusted.u.allFinite() || !adjusted.covariance.allFinite()) return std::nullopt;
  double largest = kSuspicious;
  for (Eigen::Index k = 0; k < A.rows(); ++k) {
    if (left_out[static_cast<std::size_t>(k)]) continue;
    const double redundancy = 1.0 - A.row(k).dot(adjusted.covariance * A.row(k).transpose());
    if (redundancy < kControlled) continue;
    const double w = std::abs(y(k) - A.row(k).dot(adjusted.u)) / std::sqrt(redundancy);
    if (w < largest) continue;
    largest = w;
    adjusted.outlier = k;
  }
  return adjusted;
}

/// Of the satellites left, from unit ranges with a clock for each system.
double integer_pdop(const IntegerRows& p, const std::vector<bool>& left_out) {
  std::map<SatelliteSystem, std::map<record::Satellite, Eigen::Vector3d>> systems;
  for (std::size_t k = 0; k < p.ways.size(); ++k)
    if (!left_out[k]) systems[p.ambiguities[k].satellite.system][p.ambiguities[k].satellite] = p.ways[k];
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  for (const auto& [system, ways] : systems) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& [satellite, way] : ways) mean += way / static_cast<double>(ways.size());
    for (const auto& [satellite, way] : ways) N += (way - mean) * (way - mean).transpose();
  }
  const double squared = N.inverse().trace();
  return squared > 0.0 && std::isfinite(squared) ? std::sqrt(squared) : std::numeric_limits<double>::infinity();
}

}  // namespace

std::optional<IntegerPosition> integer_position(const DifferenceEpoch& epoch, const FloatEpoch& updated,
                                                const RelativeState& state, const FixedSolution& fixed) {
  const IntegerRows p = integer_rows(epoch, updated, state, fixed);
  std::vector<bool> left_out(p.ambiguities.size(), false);
  IntegerPosition position;
  if (p.ambiguities.empty()) return std::nullopt;
  for (;;) {
    const std::optional<IntegerAdjustment> adjusted = adjust_integers(p, left_out);
    if (!adjusted) {
      position.pdop = std::numeric_limits<double>::infinity();
      return position;
    }
    if (!adjusted->outlier) {
      position.step = fixed.x - (state.x - updated.step);
      position.step.head<3>() = adjusted->u.head<3>();
      position.covariance_e = adjusted->covariance.topLeftCorner<3, 3>();
      position.pdop = integer_pdop(p, left_out);
      return position;
    }
    const auto k = static_cast<std::size_t>(*adjusted->outlier);
    left_out[k] = true;
    position.contradicted.push_back(p.ambiguities[k]);
  }
}

}  // namespace coast::carrier
