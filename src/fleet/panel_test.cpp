#include "panel_test.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include "coast/geo/units.hpp"

namespace coast::fleet {

namespace {

constexpr double kClip = 3.0;       // of scores: keeps what a step of many sigmas says, and bounds a single mission
constexpr double kScaleClip = 1.5;  // of the scale, which a unit that has changed must not enlarge
constexpr std::size_t kFewest = 3;  // missions on either side of a step: fewer may be single missions that depart
constexpr int kFewestShared = 3;    // units that a shared change must touch

/// E min(x^2, c^2) of the standard normal distribution.
double clipped_variance(double c) {
  const double density = std::exp(-0.5 * c * c) / std::sqrt(2.0 * geo::kPi);
  const double beyond = std::erfc(c / std::sqrt(2.0));
  return 1.0 - beyond - 2.0 * c * density + c * c * beyond;
}

Eigen::VectorXd clipped(const Eigen::VectorXd& r, double c) {
  return r.cwiseMax(-c).cwiseMin(c);
}

/// z - basis beta with basis' clip(z - basis beta) = 0: Huber's modified residuals, which need no new factorisation.
void robust_residuals(const Eigen::MatrixXd& basis, const Eigen::VectorXd& z, double scale, Eigen::VectorXd& beta,
                      Eigen::VectorXd& r) {
  constexpr int kMost = 12;
  for (int step = 0; step < kMost; ++step) {
    r.noalias() = z - basis * beta;
    const Eigen::VectorXd correction = basis.transpose() * clipped(r, kClip * scale);
    beta += correction;
    if (correction.cwiseAbs().maxCoeff() < 1e-4 * scale) break;
  }
  r.noalias() = z - basis * beta;
}

}  // namespace

WhitenedUnit whiten(const Observations& o, const Scatter& scatter) {
  WhitenedUnit unit;
  const Eigen::MatrixXd L = scatter_factor(o.sigma, o.t, scatter);
  const auto lower = L.triangularView<Eigen::Lower>();
  unit.z = lower.solve(o.y);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(lower.solve(o.X));
  unit.basis = qr.householderQ() * Eigen::MatrixXd::Identity(o.X.rows(), o.X.cols());
  unit.log_det = 2.0 * L.diagonal().array().log().sum();
  return unit;
}

RobustFit fit_robustly(const std::vector<WhitenedUnit>& units, const std::vector<Eigen::VectorXd>& z) {
  static const double kExpected = clipped_variance(kScaleClip);
  RobustFit fit;
  std::vector<Eigen::VectorXd> beta(units.size());
  fit.residuals.resize(units.size());
  double dof = 0.0;
  for (std::size_t u = 0; u < units.size(); ++u) {
    beta[u] = units[u].basis.transpose() * z[u];
    dof += static_cast<double>(z[u].size() - units[u].basis.cols());
  }
  for (int step = 0; step < 8; ++step) {
    double sum = 0.0;
    for (std::size_t u = 0; u < units.size(); ++u) {
      robust_residuals(units[u].basis, z[u], fit.scale, beta[u], fit.residuals[u]);
      sum += clipped(fit.residuals[u] / fit.scale, kScaleClip).squaredNorm();
    }
    if (dof < 1.0) break;
    const double factor = std::max(std::sqrt(sum / (kExpected * dof)), 1e-3);
    fit.scale *= factor;
    if (std::abs(factor - 1.0) < 1e-3) break;
  }
  fit.scale = std::max(fit.scale, 1e-12);
  for (Eigen::VectorXd& r : fit.residuals) r /= fit.scale;
  return fit;
}

double loss(const Eigen::VectorXd& residuals) {
  double sum = 0.0;
  for (const double r : residuals) sum += std::abs(r) < kClip ? r * r : kClip * (2.0 * std::abs(r) - kClip);
  return sum;
}

PanelTest::PanelTest(const Panel& panel, const std::vector<Change>& changes, const Scatter& scatter,
                     const std::vector<std::vector<bool>>& left_out) {
  collect_levels(panel);
  for (std::size_t u = 0; u < panel.series.size(); ++u) {
    const Design design = design_of(panel.series[u], u, changes, left_out.empty() ? std::vector<bool>{} : left_out[u]);
    add_unit(panel.series[u], design, scatter, changes, u);
    for (const double t : tested_.back().dates) timeline_.emplace_back(t, u);
  }
  std::ranges::sort(timeline_);
}

void PanelTest::collect_levels(const Panel& panel) {
  std::map<std::pair<std::size_t, std::string>, std::size_t> counts;
  for (const Series& series : panel.series)
    for (const Estimate& e : series.estimates)
      for (std::size_t f = 0; f < e.groups.size(); ++f) ++counts[{f, e.groups[f]}];
  for (const auto& entry : counts) {
    const auto& key = entry.first;  // Clang 14 captures no structured bindings
    const std::size_t count = entry.second;
    const bool usual = std::ranges::all_of(counts, [&](const auto& other) {
      return other.first.first != key.first || other.second < count ||
             (other.second == count && other.first.second >= key.second);
    });
    if (!usual) levels_.push_back({key.first, key.second});
  }
}

void PanelTest::add_unit(const Series& series, const Design& design, const Scatter& scatter, const std::vector<Change>& changes,
                         std::size_t index) {
  const Observations& o = design.observations;
  const WhitenedUnit& unit = units_.emplace_back(whiten(o, scatter));
  Tested& tested = tested_.emplace_back();
  const auto n = static_cast<std::size_t>(o.y.size());
  tested.dates.assign(o.t.begin(), o.t.end());
  const std::size_t count = (n > 0 ? n : 1) + levels_.size();
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(o.y.size(), static_cast<Eigen::Index>(count));
  tested.for_unit.assign(count, false);
  std::vector<std::size_t> cuts{0, n};  // where steps of this unit are already
  for (std::size_t k = 0; k < n; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    C(row, 0) = o.t[row] - o.t.mean();
    C.row(row).segment(1, row).setOnes();
    for (std::size_t l = 0; l < levels_.size(); ++l)
      if (series.estimates[design.rows[k]].groups[levels_[l].factor] == levels_[l].name)
        C(row, static_cast<Eigen::Index>(count - levels_.size() + l)) = 1.0;
  }
  for (const Change& change : changes)
    if (change.kind == ChangeKind::kStep && std::ranges::find(change.units, index) != change.units.end())
      cuts.push_back(static_cast<std::size_t>(std::ranges::count_if(tested.dates, [&](double t) { return t <= change.t; })));
  tested.for_unit[0] = n >= 2 * kFewest - 1;
  for (std::size_t k = kFewest; k + kFewest <= n; ++k)
    tested.for_unit[k] =
        std::ranges::all_of(cuts, [&](std::size_t cut) { return std::max(cut, k) - std::min(cut, k) >= kFewest; });
  const Eigen::MatrixXd L = scatter_factor(o.sigma, o.t, scatter);
  const Eigen::MatrixXd white = L.triangularView<Eigen::Lower>().solve(C);
  tested.columns = white - unit.basis * (unit.basis.transpose() * white);
  tested.energy = tested.columns.colwise().squaredNorm().transpose();
  for (Eigen::Index j = 0; j < C.cols(); ++j)
    if (tested.energy[j] <= 1e-6 * white.col(j).squaredNorm()) tested.energy[j] = 0.0;
}

std::vector<Eigen::VectorXd> PanelTest::values() const {
  std::vector<Eigen::VectorXd> z;
  z.reserve(units_.size());
  for (const WhitenedUnit& unit : units_) z.push_back(unit.z);
  return z;
}

std::vector<Eigen::VectorXd> PanelTest::scores(const std::vector<Eigen::VectorXd>& z) const {
  std::vector<Eigen::VectorXd> scores = fit_robustly(units_, z).residuals;
  for (std::size_t u = 0; u < units_.size(); ++u) scores[u] = tested_[u].columns.transpose() * clipped(scores[u], kClip);
  return scores;
}

void PanelTest::consider(Candidate& best, const Sum& sum, const Candidate& candidate) const {
  if (sum.energy <= 0.0) return;
  const double statistic = sum.score * sum.score / sum.energy;
  if (statistic <= best.statistic) return;
  best = candidate;
  best.statistic = statistic;
}

void PanelTest::shared_steps(const std::vector<Eigen::VectorXd>& scores, Candidate& best) const {
  Sum sum;
  std::vector<Eigen::Index> split(units_.size(), 0);
  const auto part = [&](std::size_t u, double sign) {
    const auto n = static_cast<Eigen::Index>(tested_[u].dates.size());
    const Eigen::Index k = split[u];
    if (k < 1 || k >= n || tested_[u].energy[k] == 0.0) return;
    sum.score += sign * scores[u][k];
    sum.energy += sign * tested_[u].energy[k];
    sum.units += sign > 0.0 ? 1 : -1;
  };
  for (std::size_t i = 0; i + 1 < timeline_.size(); ++i) {
    const std::size_t u = timeline_[i].second;
    part(u, -1.0);
    ++split[u];
    part(u, 1.0);
    if (sum.units < kFewestShared || !(timeline_[i + 1].first > timeline_[i].first)) continue;
    consider(best, sum, {ChangeKind::kStep, true, 0, 0.5 * (timeline_[i].first + timeline_[i + 1].first), 0, "", 0.0});
  }
}

Strongest PanelTest::strongest(const std::vector<Eigen::VectorXd>& z) const {
  const std::vector<Eigen::VectorXd> found = scores(z);
  Strongest best;
  Sum drift;
  std::vector<Sum> of_levels(levels_.size());
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const Tested& tested = tested_[u];
    const auto add = [&](Sum& sum, Eigen::Index column) {
      if (tested.energy[column] == 0.0) return;
      sum.score += found[u][column];
      sum.energy += tested.energy[column];
      ++sum.units;
    };
    add(drift, 0);
    const Eigen::Index first = tested.energy.size() - static_cast<Eigen::Index>(levels_.size());
    for (std::size_t l = 0; l < levels_.size(); ++l) add(of_levels[l], first + static_cast<Eigen::Index>(l));
    for (Eigen::Index j = 0; j < first; ++j) {
      if (!tested.for_unit[static_cast<std::size_t>(j)]) continue;
      const auto k = static_cast<std::size_t>(j);
      const double t = j == 0 ? 0.0 : 0.5 * (tested.dates[k - 1] + tested.dates[k]);
      consider(best.own, {found[u][j], tested.energy[j], 1},
               {j == 0 ? ChangeKind::kDrift : ChangeKind::kStep, false, u, t, 0, "", 0.0});
    }
  }
  if (drift.units >= kFewestShared) consider(best.shared, drift, {ChangeKind::kDrift, true, 0, 0.0, 0, "", 0.0});
  for (std::size_t l = 0; l < levels_.size(); ++l)
    consider(best.shared, of_levels[l], {ChangeKind::kGroupLevel, true, 0, 0.0, levels_[l].factor, levels_[l].name, 0.0});
  shared_steps(found, best.shared);
  return best;
}

Eigen::Index PanelTest::column_of(const Candidate& candidate, std::size_t unit) const {
  const Tested& tested = tested_[unit];
  if (candidate.kind == ChangeKind::kDrift) return 0;
  if (candidate.kind == ChangeKind::kGroupLevel) {
    const auto level = std::ranges::find_if(
        levels_, [&](const Level& l) { return l.factor == candidate.factor && l.name == candidate.level; });
    return tested.energy.size() - static_cast<Eigen::Index>(levels_.end() - level);
  }
  return std::ranges::count_if(tested.dates, [&](double t) { return t <= candidate.t; });
}

std::vector<double> PanelTest::of_units(const Candidate& candidate) const {
  const std::vector<Eigen::VectorXd> found = scores(values());
  std::vector<double> statistics(units_.size(), 0.0);
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const auto n = static_cast<Eigen::Index>(tested_[u].dates.size());
    const Eigen::Index j = column_of(candidate, u);
    if (candidate.kind == ChangeKind::kStep && (j < 1 || j >= n)) continue;
    if (tested_[u].energy[j] > 0.0) statistics[u] = found[u][j] * found[u][j] / tested_[u].energy[j];
  }
  return statistics;
}

}  // namespace coast::fleet
