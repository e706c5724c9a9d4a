// Missions that depart: mean shifts of single estimates.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "search.hpp"

namespace coast::fleet {

namespace {

/// Every estimate of a unit against all the others. With P = V^-1 - V^-1 X (X'V^-1 X)^-1 X'V^-1 the likelihood-ratio statistic
/// of a shift of estimate i is (P y)_i^2 / P_ii, and (P y)_i / P_ii the shift.
void compare(const Series& series, std::size_t index, const PanelChanges& model, const std::vector<bool>& left_out,
             std::vector<Departure>& out) {
  const Design design = design_of(series, index, model.changes, left_out);
  const Observations& o = design.observations;
  if (o.y.size() <= o.X.cols()) return;
  const WhitenedUnit unit = whiten(o, model.scatter);
  const Eigen::MatrixXd L = scatter_factor(o.sigma, o.t, model.scatter);
  const Eigen::MatrixXd W = L.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(o.y.size(), o.y.size()));
  const Eigen::MatrixXd M = W - unit.basis * (unit.basis.transpose() * W);
  const Eigen::MatrixXd P = W.transpose() * M;
  const Eigen::VectorXd residual = P * o.y;
  for (Eigen::Index i = 0; i < o.y.size(); ++i) {
    if (P(i, i) * (o.sigma[i] * o.sigma[i] + model.scatter.tau * model.scatter.tau) < 1e-6) continue;  // no other tells
    Departure d;
    d.series = index;
    d.index = design.rows[static_cast<std::size_t>(i)];
    d.expected = o.y[i] - residual[i] / P(i, i);
    d.standardised = residual[i] / std::sqrt(P(i, i));
    out.push_back(d);
  }
}

/// Tails of a fleet, and of each of its panels.
struct FleetTails {
  Tails common;
  std::vector<Tails> own;

  /// By the tails of the whole fleet, or by those of its panel where they are heavier: figures differ in how much of their
  /// scatter is the missions' own, and by common tails alone those with the heaviest would depart too often.
  [[nodiscard]] double probability(const Departure& d) const {
    const auto by = [&d](const Tails& t) { return student_two_sided(d.standardised / std::max(t.scale, 1e-12), t.nu); };
    return std::max(by(common), by(own[d.panel]));
  }
};

/// @param all    largest first
/// @param first  how many of them are in question
FleetTails tails_without(const std::vector<Departure>& all, std::size_t first, std::size_t panels) {
  std::vector<double> fleet;
  std::vector<std::vector<double>> of_panel(panels);
  std::vector<std::size_t> in_question(panels, 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i < first) {
      ++in_question[all[i].panel];
      continue;
    }
    fleet.push_back(all[i].standardised);
    of_panel[all[i].panel].push_back(all[i].standardised);
  }
  FleetTails tails{heaviest_tails(fleet, first), {}};
  for (std::size_t p = 0; p < panels; ++p) tails.own.push_back(likeliest_tails(of_panel[p], in_question[p]));
  return tails;
}

/// Whether the largest departs: by itself, or because a smaller one does when all that are as large are in question with it. Of
/// several that depart one would else hide the others. Rosner (1983), Technometrics 25, 165.
/// @param all  largest first
bool largest_departs(std::vector<Departure>& all, std::size_t panels, double level) {
  constexpr double kSuspect = 3.5;
  constexpr std::size_t kMost = 20;
  bool departs = false;
  if (level <= 0.0) return departs;
  for (std::size_t k = 1; k <= std::min(kMost, all.size()) && std::abs(all[k - 1].standardised) > kSuspect && !departs; ++k) {
    const FleetTails tails = tails_without(all, k, panels);
    departs = tails.probability(all[k - 1]) * static_cast<double>(all.size() - k + 1) <= level;
    if (departs) all[0].p = tails.probability(all[0]);
  }
  return departs;
}

/// Most improbable first; of those whose probabilities are 0 the largest.
bool rarer(const Departure& a, const Departure& b) {
  return a.p != b.p ? a.p < b.p : std::abs(a.standardised) > std::abs(b.standardised);
}

}  // namespace

std::vector<Departure> find_departures(const Fleet& fleet, const std::vector<PanelChanges>& panels, double level,
                                       std::vector<LeftOut>& left_out, Tails& tails) {
  std::vector<std::vector<std::vector<Departure>>> all(fleet.panels.size());  // by panel and series
  const auto refresh = [&](std::size_t p, std::size_t s) {
    all[p][s].clear();
    compare(fleet.panels[p].series[s], s, panels[p], left_out[p][s], all[p][s]);
    for (Departure& d : all[p][s]) d.panel = p;
  };
  for (std::size_t p = 0; p < fleet.panels.size(); ++p) {
    all[p].resize(fleet.panels[p].series.size());
    for (std::size_t s = 0; s < all[p].size(); ++s) refresh(p, s);
  }
  std::vector<Departure> outliers;
  std::vector<Departure> rest;
  constexpr std::size_t kMost = 200;
  while (true) {
    rest.clear();
    for (const auto& of_panel : all)
      for (const auto& of_series : of_panel) rest.insert(rest.end(), of_series.begin(), of_series.end());
    if (rest.empty()) break;
    std::ranges::sort(
        rest, [](const Departure& a, const Departure& b) { return std::abs(a.standardised) > std::abs(b.standardised); });
    if (outliers.size() >= kMost || !largest_departs(rest, fleet.panels.size(), level)) break;
    Departure& first = rest.front();
    first.outlier = true;
    outliers.push_back(first);
    left_out[first.panel][first.series][first.index] = true;
    refresh(first.panel, first.series);
  }
  const FleetTails found = tails_without(rest, std::min<std::size_t>(1, rest.size()), fleet.panels.size());
  tails = found.common;
  for (Departure& d : rest) d.p = found.probability(d);
  std::ranges::sort(rest, rarer);
  outliers.insert(outliers.end(), rest.begin(), rest.end());
  return outliers;
}

}  // namespace coast::fleet
