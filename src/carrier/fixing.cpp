#include "fixing.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "coast/carrier/integer_least_squares.hpp"
#include "coast/record/error.hpp"

namespace coast::carrier {

namespace {

using Kind = Unknown::Kind;
using record::Satellite;
using record::SatelliteSystem;

/// An ambiguity of this epoch that may be an integer.
struct Fixable {
  Satellite satellite;
  char band = '1';
  double elevation = 0.0;
  Eigen::Index index = 0;  ///< in the state
};

std::vector<Fixable> fixable(const DifferenceEpoch& epoch, const FloatEpoch& updated, const RelativeState& state,
                             double elevation_mask) {
  std::vector<Fixable> all;
  for (const Row& row : updated.dd.rows) {
    if (!row.phase || row.direction.elevation < elevation_mask) continue;
    const SatelliteDifference& satellite = epoch.satellites[row.satellite];
    const BandDifference& band = satellite.bands[row.band];
    // Frequencies of GLONASS differ: its double differences are not integers.
    if (band.half_cycle || satellite.satellite.system == SatelliteSystem::kGlonass) continue;
    const Eigen::Index i = state.index({Kind::kAmbiguity, satellite.satellite, band.band, band.arc});
    if (i >= 0) all.push_back({satellite.satellite, band.band, row.direction.elevation, i});
  }
  return all;
}

/// Double differences of a set of ambiguities: against the highest satellite of each system and band.
Eigen::MatrixXd differencing(const std::vector<Fixable>& set, Eigen::Index states) {
  std::map<std::pair<SatelliteSystem, char>, std::vector<const Fixable*>> groups;
  for (const Fixable& f : set) groups[{f.satellite.system, f.band}].push_back(&f);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(set.size() - groups.size()), states);
  Eigen::Index row = 0;
  for (const auto& [group, members] : groups) {
    const Fixable* reference = *std::ranges::max_element(members, {}, [](const Fixable* f) { return f->elevation; });
    for (const Fixable* f : members) {
      if (f == reference) continue;
      D(row, f->index) = 1.0;
      D(row, reference->index) = -1.0;
      ++row;
    }
  }
  return D;
}

/// One set of ambiguities with its best integers.
struct Attempt {
  std::vector<Fixable> set;
  Eigen::MatrixXd D;
  Eigen::VectorXd a;
  Eigen::MatrixXd PDt;
  Eigen::MatrixXd Q;
  IntegerSolutions integers;
  double ratio = 0.0;
};

std::optional<Attempt> attempt(const std::vector<Fixable>& set, const RelativeState& state) {
  constexpr Eigen::Index kFewest = 4;
  Attempt t;
  t.set = set;
  t.D = differencing(set, state.size());
  if (t.D.rows() < kFewest) return std::nullopt;
  t.a = t.D * state.x;
  t.PDt = state.P * t.D.transpose();
  t.Q = t.D * t.PDt;
  t.Q = 0.5 * (t.Q + t.Q.transpose()).eval();
  try {
    t.integers = integer_least_squares(t.a, t.Q);
  } catch (const NumericalError&) {
    return std::nullopt;
  }
  t.ratio = t.integers.ratio();
  return t;
}

bool good(const Attempt& t, const FixingOptions& options) {
  return t.ratio >= options.ratio && t.integers.success_rate >= options.success_rate;
}

std::vector<Satellite> satellites_of(const std::vector<Fixable>& set) {
  std::vector<Satellite> satellites;
  for (const Fixable& f : set)
    if (std::ranges::find(satellites, f.satellite) == satellites.end()) satellites.push_back(f.satellite);
  return satellites;
}

std::vector<Fixable> without(std::vector<Fixable> set, Satellite satellite) {
  std::erase_if(set, [&](const Fixable& f) { return f.satellite == satellite; });
  return set;
}

/// All; without those that did not do last time; without one satellite, whichever it is; without ever more of the lowest, down
/// to half: few integers that stand out are often wrong.
std::optional<Attempt> search(const std::vector<Fixable>& all, const RelativeState& state, const FixingOptions& options,
                              const std::vector<Satellite>& last_without) {
  std::optional<Attempt> best = attempt(all, state);
  if (!best || good(*best, options)) return best;
  const auto consider = [&](const std::vector<Fixable>& set) {
    if (2 * set.size() < all.size()) return false;
    std::optional<Attempt> next = attempt(set, state);
    if (!next) return false;
    if (next->integers.success_rate >= options.success_rate && next->ratio > best->ratio) best = std::move(next);
    return true;
  };
  std::vector<Fixable> set = all;
  for (const Satellite satellite : last_without) set = without(set, satellite);
  if (set.size() < all.size()) consider(set);
  if (good(*best, options)) return best;
  std::vector<Satellite> satellites = satellites_of(all);
  for (const Satellite satellite : satellites) consider(without(all, satellite));
  if (good(*best, options)) return best;
  std::map<Satellite, double> elevations;
  for (const Fixable& f : all) elevations[f.satellite] = f.elevation;
  std::ranges::sort(satellites, {}, [&](Satellite s) { return elevations.at(s); });
  set = all;
  for (const Satellite satellite : satellites) {
    set = without(set, satellite);
    if (!consider(set) || good(*best, options)) break;
  }
  return best;
}

}  // namespace

FixedSolution AmbiguityFixing::fix(const DifferenceEpoch& epoch, const FloatEpoch& updated, const RelativeState& state) {
  FixedSolution solution;
  const std::vector<Fixable> all = fixable(epoch, updated, state, options_.elevation_mask);
  const std::optional<Attempt> best = search(all, state, options_, without_);
  if (!best) {
    solution.shortfall = Shortfall::kFewAmbiguities;
    return solution;
  }
  solution.ratio = best->ratio;
  solution.success_rate = best->integers.success_rate;
  if (!good(*best, options_)) {
    solution.shortfall =
        best->integers.success_rate < options_.success_rate ? Shortfall::kLowSuccessRate : Shortfall::kLowRatio;
    return solution;
  }
  const Eigen::LDLT<Eigen::MatrixXd> Q(best->Q);
  solution.x = state.x - best->PDt * Q.solve(best->a - best->integers.candidates.col(0));
  const Eigen::MatrixXd position = best->PDt.topRows<3>();
  solution.position_covariance_e = state.P.topLeftCorner<3, 3>() - position * Q.solve(position.transpose());
  solution.satellites = satellites_of(best->set);
  without_ = satellites_of(all);
  std::erase_if(without_, [&](Satellite s) { return std::ranges::find(solution.satellites, s) != solution.satellites.end(); });
  solution.ambiguities = static_cast<int>(best->a.size());
  constexpr double kCentimetres = 0.05;  // m, sd in space
  solution.fixed = true;
  if (!(solution.position_covariance_e.trace() < kCentimetres * kCentimetres)) solution.shortfall = Shortfall::kBadGeometry;
  return solution;
}

}  // namespace coast::carrier
