#include "known_integers.hpp"

#include <algorithm>
#include <functional>
#include <set>

namespace coast::carrier {

namespace {

using Edge = std::pair<Unknown, Unknown>;

/// The integer that most epochs agree on for a pair of arcs.
struct Majority {
  Edge edge;
  double integer = 0.0;  ///< first minus second
  int votes = 0, of = 0;
};

std::vector<Majority> majorities(const AmbiguityHistory& forward, const AmbiguityHistory& backward) {
  std::map<Edge, std::map<double, int>> ballots;
  for (const AmbiguityHistory* history : {&forward, &backward})
    for (const std::vector<FixedPair>& epoch : history->fixed)
      for (const FixedPair& p : epoch) {
        const bool ordered = p.ambiguity < p.reference;
        ++ballots[ordered ? Edge{p.ambiguity, p.reference} : Edge{p.reference, p.ambiguity}][ordered ? p.integer : -p.integer];
      }
  std::vector<Majority> all;
  for (const auto& [edge, ballot] : ballots) {
    Majority m{edge, 0.0, 0, 0};
    for (const auto& [integer, votes] : ballot) {
      m.of += votes;
      if (votes <= m.votes) continue;
      m.votes = votes;
      m.integer = integer;
    }
    all.push_back(m);
  }
  return all;
}

}  // namespace

HeldIntegers held(const std::vector<FixedPair>& pairs, const RelativeState& state) {
  constexpr double kSd = 0.01;  // cycles: by which phase multipath may still change held ambiguities
  const auto rows = static_cast<Eigen::Index>(pairs.size());
  HeldIntegers h{Eigen::MatrixXd::Zero(rows, state.size()), Eigen::VectorXd(rows)};
  for (Eigen::Index row = 0; row < rows; ++row) {
    const FixedPair& p = pairs[static_cast<std::size_t>(row)];
    const Eigen::Index ambiguity = state.index(p.ambiguity), reference = state.index(p.reference);
    h.H(row, ambiguity) = 1.0 / kSd;
    h.H(row, reference) = -1.0 / kSd;
    h.nu(row) = (p.integer - (state.x(ambiguity) - state.x(reference))) / kSd;
  }
  return h;
}

std::vector<FixedPair> IntegerHold::agreed(const std::vector<FixedPair>& fixed) {
  constexpr int kEnough = 3;  // epochs
  std::map<Unknown, Candidate> next;
  std::map<Unknown, double> offsets;  // of each reference: its value relative to the reference of its group at that time
  for (const FixedPair& p : fixed) {
    const auto reference = candidates_.find(p.reference), then = candidates_.find(p.ambiguity);
    if (reference != candidates_.end())
      offsets.emplace(p.reference, reference->second.value);
    else if (then != candidates_.end())
      offsets.emplace(p.reference, then->second.value - p.integer);
    next.emplace(p.reference, Candidate{0.0, reference == candidates_.end() ? 1 : reference->second.epochs + 1});
  }
  for (const FixedPair& p : fixed) {
    const auto then = candidates_.find(p.ambiguity);
    const auto offset = offsets.find(p.reference);
    const bool same = then != candidates_.end() && offset != offsets.end() && then->second.value - offset->second == p.integer;
    next[p.ambiguity] = {p.integer, same ? then->second.epochs + 1 : 1};
  }
  candidates_ = std::move(next);
  std::vector<FixedPair> pairs = fixed;
  std::erase_if(pairs, [&](const FixedPair& p) {
    return candidates_.at(p.ambiguity).epochs < kEnough || candidates_.at(p.reference).epochs < kEnough;
  });
  return pairs;
}

void split_arcs(std::vector<DifferenceEpoch>& epochs, AmbiguityHistory& forward, AmbiguityHistory& backward) {
  struct Arc {
    int given = -1, number = 0;
    bool ended = false;
  };
  std::map<std::pair<record::Satellite, char>, Arc> arcs;
  int last = 0;
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    const auto contains = [&](const std::vector<Unknown>& restarted, const Unknown& ambiguity) {
      return std::ranges::find(restarted, ambiguity) != restarted.end();
    };
    for (SatelliteDifference& satellite : epochs[i].satellites)
      for (BandDifference& band : satellite.bands) {
        if (!band.phase) continue;
        const Unknown ambiguity{Unknown::Kind::kAmbiguity, satellite.satellite, band.band, band.arc};
        Arc& arc = arcs[{satellite.satellite, band.band}];
        if (arc.given != band.arc || arc.ended || contains(forward.restarted[i], ambiguity)) arc = {band.arc, ++last, false};
        arc.ended = contains(backward.restarted[i], ambiguity);
        band.arc = arc.number;
      }
    for (AmbiguityHistory* history : {&forward, &backward})
      for (FixedPair& p : history->fixed[i])
        for (Unknown* u : {&p.ambiguity, &p.reference}) u->arc = arcs.at({u->satellite, u->band}).number;
  }
}

KnownIntegers::KnownIntegers(const AmbiguityHistory& forward, const AmbiguityHistory& backward) {
  constexpr int kEnough = 5;          // epochs
  constexpr double kAgreement = 0.9;  // of them
  std::vector<Majority> edges = majorities(forward, backward);
  std::erase_if(edges, [](const Majority& m) { return m.votes < kEnough || m.votes < kAgreement * m.of; });
  // A maximum spanning forest (Kruskal): the most certain differences first.
  std::ranges::stable_sort(edges, std::greater{}, &Majority::votes);
  std::map<int, std::vector<Unknown>> components;
  int last = 0;
  const auto place = [&](const Unknown& arc) {
    const auto [at, is_new] = places_.try_emplace(arc, Place{last, 0.0});
    if (is_new) components[last++] = {arc};
    return at->second;
  };
  for (const Majority& m : edges) {
    const Place first = place(m.edge.first), second = place(m.edge.second);
    if (first.component == second.component) continue;
    // first + shift = second + integer
    const double shift = second.integer + m.integer - first.integer;
    std::vector<Unknown>& target = components[second.component];
    for (const Unknown& arc : components[first.component]) {
      Place& moved = places_.at(arc);
      moved = {second.component, moved.integer + shift};
      target.push_back(arc);
    }
    components.erase(first.component);
  }
}

std::vector<FixedPair> KnownIntegers::of(const DifferenceEpoch& epoch) const {
  std::vector<FixedPair> pairs;
  std::map<int, std::pair<Unknown, double>> references;
  for (const SatelliteDifference& satellite : epoch.satellites)
    for (const BandDifference& band : satellite.bands) {
      if (!band.phase || band.half_cycle) continue;
      const Unknown ambiguity{Unknown::Kind::kAmbiguity, satellite.satellite, band.band, band.arc};
      const auto at = places_.find(ambiguity);
      if (at == places_.end()) continue;
      const auto [reference, is_first] = references.try_emplace(at->second.component, std::pair{ambiguity, at->second.integer});
      if (!is_first) pairs.push_back({ambiguity, reference->second.first, at->second.integer - reference->second.second});
    }
  return pairs;
}

}  // namespace coast::carrier
