#include "fixing.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

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
    if (row.observable != Observable::kPhase || row.direction.elevation < elevation_mask) continue;
    const SatelliteDifference& satellite = epoch.satellites[row.satellite];
    const BandDifference& band = satellite.bands[row.band];
    if (band.half_cycle) continue;
    const Eigen::Index i = state.index({Kind::kAmbiguity, satellite.satellite, band.band, band.arc});
    if (i >= 0) all.push_back({satellite.satellite, band.band, row.direction.elevation, i});
  }
  return all;
}

/// An ambiguity and its reference, as indices of the state.
struct Pair {
  Eigen::Index ambiguity = 0, reference = 0;
  Satellite satellite;
};

/// Double differences of a set of ambiguities: relative to the highest satellite of each system and band.
std::vector<Pair> differencing(const std::vector<Fixable>& set) {
  std::map<std::pair<SatelliteSystem, char>, std::vector<const Fixable*>> groups;
  for (const Fixable& f : set) groups[{f.satellite.system, f.band}].push_back(&f);
  std::vector<Pair> pairs;
  for (const auto& [group, members] : groups) {
    const Fixable* reference = *std::ranges::max_element(members, {}, [](const Fixable* f) { return f->elevation; });
    for (const Fixable* f : members)
      if (f != reference) pairs.push_back({f->index, reference->index, f->satellite});
  }
  return pairs;
}

std::vector<FixedPair> named(const std::vector<Pair>& pairs, const RelativeState& state, const Eigen::VectorXd& integers) {
  std::vector<FixedPair> names;
  const auto name = [&](Eigen::Index i) { return state.unknowns()[static_cast<std::size_t>(i)]; };
  for (std::size_t k = 0; k < pairs.size(); ++k)
    names.push_back({name(pairs[k].ambiguity), name(pairs[k].reference), integers(static_cast<Eigen::Index>(k))});
  return names;
}

/// One set of ambiguities with its best integers.
struct Attempt {
  std::vector<Fixable> set;
  std::vector<Pair> pairs;
  Eigen::VectorXd a;
  Eigen::MatrixXd PDt;
  Eigen::MatrixXd Q;
  IntegerSolutions integers;
  double ratio = 0.0;
};

std::optional<Attempt> attempt(const std::vector<Fixable>& set, const RelativeState& state, double least_success) {
  constexpr Eigen::Index kFewest = 4;
  Attempt t;
  t.set = set;
  t.pairs = differencing(set);
  const auto n = static_cast<Eigen::Index>(t.pairs.size());
  if (n < kFewest) return std::nullopt;
  t.a.resize(n);
  t.PDt.resize(state.size(), n);
  t.Q.resize(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Pair& p = t.pairs[static_cast<std::size_t>(k)];
    t.a(k) = state.x(p.ambiguity) - state.x(p.reference);
    t.PDt.col(k) = state.P.col(p.ambiguity) - state.P.col(p.reference);
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const Pair& p = t.pairs[static_cast<std::size_t>(k)];
    t.Q.row(k) = t.PDt.row(p.ambiguity) - t.PDt.row(p.reference);
  }
  t.Q = 0.5 * (t.Q + t.Q.transpose()).eval();
  try {
    t.integers = integer_least_squares(t.a, t.Q, 2, least_success);
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

/// Satellites, the one with the least certain ambiguities first.
std::vector<Satellite> by_uncertainty(const Attempt& t) {
  std::map<Satellite, double> variances;
  for (std::size_t k = 0; k < t.pairs.size(); ++k) {
    double& variance = variances[t.pairs[k].satellite];
    variance = std::max(variance, t.Q(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)));
  }
  std::vector<Satellite> satellites = satellites_of(t.set);
  std::ranges::sort(satellites, std::greater{}, [&](Satellite s) { return variances[s]; });
  return satellites;
}

std::vector<Satellite> by_elevation(const std::vector<Fixable>& set) {
  std::map<Satellite, double> elevations;
  for (const Fixable& f : set) elevations[f.satellite] = f.elevation;
  std::vector<Satellite> satellites = satellites_of(set);
  std::ranges::sort(satellites, {}, [&](Satellite s) { return elevations.at(s); });
  return satellites;
}

/// Those of known integers.
std::vector<Fixable> among(std::vector<Fixable> set, const std::vector<FixedPair>& known, const RelativeState& state) {
  std::set<Eigen::Index> indices;
  for (const FixedPair& p : known) indices.insert({state.index(p.ambiguity), state.index(p.reference)});
  std::erase_if(set, [&](const Fixable& f) { return !indices.contains(f.index); });
  return set;
}

/// Those of satellites none of whose codes was left out: a reflection is late in code and phase.
std::vector<Fixable> with_good_codes(std::vector<Fixable> set, const FloatEpoch& updated) {
  for (const SignalResidual& r : updated.left_out)
    if (!r.phase) set = without(set, r.satellite);
  return set;
}

/// Partial fixing. At least half of the ambiguities are kept: few integers that seem significant are often wrong.
class PartialFixing {
 public:
  PartialFixing(const std::vector<Fixable>& all, const RelativeState& state, const FixingOptions& options)
      : all_(all), state_(state), options_(options), best_(attempt(all, state, options.success_rate)) {}

  /// All; else those of known integers; else those of satellites with good codes; else without those left float in the previous
  /// epoch; else, if the integers are too uncertain, without the least certain, if they are not significant, without one
  /// satellite, tried in turn, or without the lowest.
  std::optional<Attempt> run(const std::vector<Satellite>& without_last, const std::vector<Fixable>& known,
                             const std::vector<Fixable>& trusted) {
    if (!best_ || done()) return best_;
    const Attempt whole = *best_;
    for (const std::vector<Fixable>& likely : {known, trusted}) {
      if (likely.empty() || likely.size() == all_.size()) continue;
      consider(likely);
      if (done()) return best_;
    }
    std::vector<Fixable> set = all_;
    for (const Satellite satellite : without_last) set = without(set, satellite);
    if (set.size() < all_.size()) consider(set);
    if (done()) return best_;
    if (whole.integers.success_rate < options_.success_rate) {
      drop(by_uncertainty(whole));
      return best_;
    }
    for (const Satellite satellite : satellites_of(all_)) consider(without(all_, satellite));
    if (!done()) drop(by_elevation(all_));
    return best_;
  }

 private:
  [[nodiscard]] bool done() const { return good(*best_, options_); }
  /// @return whether there is a solution that is certain enough
  bool consider(const std::vector<Fixable>& set) {
    std::optional<Attempt> next = attempt(set, state_, options_.success_rate);
    if (!next || next->integers.success_rate < options_.success_rate) return false;
    if (best_->integers.success_rate < options_.success_rate || next->ratio > best_->ratio) best_ = std::move(next);
    return true;
  }
  /// Drops more and more of these satellites, in their order; none if even half of the ambiguities are too uncertain.
  void drop(const std::vector<Satellite>& satellites) {
    std::vector<std::vector<Fixable>> sets;
    std::vector<Fixable> set = all_;
    for (const Satellite satellite : satellites) {
      set = without(set, satellite);
      if (2 * set.size() < all_.size()) break;
      sets.push_back(set);
    }
    if (sets.empty() || !consider(sets.back())) return;
    for (const std::vector<Fixable>& larger : sets) {
      consider(larger);
      if (done()) return;
    }
  }

  const std::vector<Fixable>& all_;
  const RelativeState& state_;
  const FixingOptions& options_;
  std::optional<Attempt> best_;
};

/// The state conditioned on these integers, and the integers.
void take(const Attempt& t, RelativeState& state, FixedSolution& solution) {
  const Eigen::LDLT<Eigen::MatrixXd> Q(t.Q);
  const std::vector<FixedPair> pairs = named(t.pairs, state, t.integers.candidates.col(0));
  state.x -= t.PDt * Q.solve(t.a - t.integers.candidates.col(0));
  state.P -= t.PDt * Q.solve(t.PDt.transpose());
  solution.pairs.insert(solution.pairs.end(), pairs.begin(), pairs.end());
  for (const Satellite satellite : satellites_of(t.set)) solution.satellites.push_back(satellite);
  solution.ambiguities += static_cast<int>(t.a.size());
}

}  // namespace

FixedSolution AmbiguityFixing::fix(const DifferenceEpoch& epoch, const FloatEpoch& updated, const RelativeState& state,
                                   const std::vector<FixedPair>& known) {
  FixedSolution solution;
  const std::vector<Fixable> all = fixable(epoch, updated, state, options_.elevation_mask);
  std::vector<Fixable> first = all, glonass;
  std::erase_if(first, [](const Fixable& f) { return f.satellite.system == SatelliteSystem::kGlonass; });
  std::ranges::copy_if(all, std::back_inserter(glonass),
                       [](const Fixable& f) { return f.satellite.system == SatelliteSystem::kGlonass; });
  if (first.empty()) std::swap(first, glonass);
  const std::optional<Attempt> best =
      PartialFixing(first, state, options_).run(without_, among(first, known, state), with_good_codes(first, updated));
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
  RelativeState fixed = state;
  take(*best, fixed, solution);
  without_ = satellites_of(first);
  std::erase_if(without_, [&](Satellite s) { return std::ranges::find(solution.satellites, s) != solution.satellites.end(); });
  // Because of inter-frequency biases, GLONASS's integers are uncertain until the others have fixed the position.
  if (const std::optional<Attempt> more = attempt(glonass, fixed, options_.success_rate); more && good(*more, options_))
    take(*more, fixed, solution);
  solution.x = std::move(fixed.x);
  solution.P = std::move(fixed.P);
  solution.fixed = true;
  return solution;
}

}  // namespace coast::carrier
