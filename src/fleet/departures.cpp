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
    std::vector<double> others;  // the one in question must not widen the tails that it is judged by
    for (std::size_t i = 1; i < rest.size(); ++i) others.push_back(rest[i].standardised);
    tails = heaviest_tails(others);
    for (Departure& d : rest) d.p = student_two_sided(d.standardised / std::max(tails.scale, 1e-12), tails.nu);
    Departure& first = rest.front();
    if (first.p * static_cast<double>(rest.size()) > level || outliers.size() >= kMost) break;
    first.outlier = true;
    outliers.push_back(first);
    left_out[first.panel][first.series][first.index] = true;
    refresh(first.panel, first.series);
  }
  outliers.insert(outliers.end(), rest.begin(), rest.end());
  return outliers;
}

}  // namespace coast::fleet
