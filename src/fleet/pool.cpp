#include "coast/fleet/pool.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "coast/fleet/student.hpp"

namespace coast::fleet {

namespace {

/// Columns count from the last mission: the constant is then the value at its date, after all changes.
void refer_to_last(Design& design) {
  Eigen::MatrixXd& X = design.observations.X;
  for (const auto& column : design.of_changes)
    if (column) X.col(*column).array() -= X(X.rows() - 1, *column);
}

void drop(Eigen::MatrixXd& X, Eigen::Index column) {
  const Eigen::MatrixXd right = X.rightCols(X.cols() - column - 1);
  X.conservativeResize(X.rows(), X.cols() - 1);
  X.rightCols(X.cols() - column) = right;
}

/// Temperature and drift of one unit, fitted together.
void fit_slopes(const Series& series, std::size_t index, const PanelChanges& model, const std::vector<bool>& left_out,
                double scale, PooledUnit& unit) {
  std::vector<Change> changes = model.changes;
  const auto drifts = [&](const Change& c) {
    return c.kind == ChangeKind::kDrift && std::ranges::find(c.units, index) != c.units.end();
  };
  auto drift = std::ranges::find_if(changes, drifts);
  if (drift == changes.end()) {
    Change change;
    change.kind = ChangeKind::kDrift;
    change.units = {index};
    drift = changes.insert(changes.end(), change);
  }
  const Design design = design_of(series, index, changes, left_out);
  const Observations& o = design.observations;
  if (o.y.size() < o.X.cols() + 2) return;
  const LeastSquares fit = least_squares(o, model.scatter);
  const auto slope = [&](Eigen::Index column) {
    Slope s;
    s.value = fit.beta[column];
    s.sd = scale * std::sqrt(fit.covariance(column, column));
    s.likelihood_ratio = std::pow(s.value / s.sd, 2.0);
    return s;
  };
  if (design.temperature) unit.temperature = slope(*design.temperature);
  unit.mean_temperature = design.mean_temperature;
  if (const auto column = design.of_changes[static_cast<std::size_t>(drift - changes.begin())]) unit.drift = slope(*column);
}

/// Holm's correction over the units.
void mark_supported(std::vector<PooledUnit>& units, std::optional<Slope> PooledUnit::*which) {
  std::vector<Slope*> slopes;
  for (PooledUnit& unit : units)
    if (unit.*which) slopes.push_back(&*(unit.*which));
  std::ranges::sort(slopes, std::greater(), &Slope::likelihood_ratio);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    if (chi_square_1_tail(slopes[i]->likelihood_ratio) * static_cast<double>(slopes.size() - i) > 0.05) return;
    slopes[i]->supported = true;
  }
}

void fit_value(const Series& series, std::size_t index, const PanelChanges& model, const std::vector<bool>& left_out,
               PooledUnit& unit) {
  Design design = design_of(series, index, model.changes, left_out);
  Observations& o = design.observations;
  unit.missions = static_cast<int>(o.y.size());
  unit.left_out = static_cast<int>(series.estimates.size()) - unit.missions;
  if (unit.missions == 0) return;
  refer_to_last(design);
  if (design.temperature && !(unit.temperature && unit.temperature->supported)) drop(o.X, *design.temperature);
  const RandomEffects fit = random_effects(o);
  unit.value = fit.beta[0];
  unit.sd = fit.sd(0);
  unit.value_95 = fit.interval_95(0);
  unit.tau = fit.scatter.tau;
  if (fit.dof > 0) unit.tau_95 = fit.tau_95;
}

/// The second level: units about the fleet's mean.
void pool_units(PooledPanel& panel) {
  std::vector<PooledUnit*> usable;
  for (PooledUnit& unit : panel.units) {
    unit.shrunk = unit.value;
    unit.shrunk_sd = unit.sd;
    if (unit.missions > 0 && unit.sd > 0.0) usable.push_back(&unit);
  }
  if (usable.size() < 3) return;
  const auto n = static_cast<Eigen::Index>(usable.size());
  Observations o{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Ones(n, 1)};
  for (Eigen::Index i = 0; i < n; ++i) {
    o.y[i] = usable[static_cast<std::size_t>(i)]->value;
    o.sigma[i] = usable[static_cast<std::size_t>(i)]->sd;
  }
  const RandomEffects fit = random_effects(o);
  panel.mean = PooledPanel::Mean{fit.beta[0], fit.sd(0), fit.interval_95(0), fit.scatter.tau, fit.tau_95};
  const double between = fit.scatter.tau * fit.scatter.tau;
  const double mean_variance = least_squares(o, fit.scatter).covariance(0, 0);
  for (PooledUnit* unit : usable) {  // best linear unbiased prediction, with the mean estimated
    const double own = unit->sd * unit->sd;
    const double share = between / (between + own);
    unit->shrunk = fit.beta[0] + share * (unit->value - fit.beta[0]);
    unit->shrunk_sd = std::sqrt(share * own + (1.0 - share) * (1.0 - share) * mean_variance);
  }
}

}  // namespace

PooledPanel pool(const Panel& panel, const PanelChanges& changes, const std::vector<std::vector<bool>>& left_out) {
  PooledPanel pooled;
  pooled.units.resize(panel.series.size());
  const double scale = robust_scale(panel, changes, left_out);
  for (std::size_t u = 0; u < panel.series.size(); ++u)
    fit_slopes(panel.series[u], u, changes, left_out[u], scale, pooled.units[u]);
  mark_supported(pooled.units, &PooledUnit::temperature);
  mark_supported(pooled.units, &PooledUnit::drift);
  for (std::size_t u = 0; u < panel.series.size(); ++u) fit_value(panel.series[u], u, changes, left_out[u], pooled.units[u]);
  pool_units(pooled);
  return pooled;
}

}  // namespace coast::fleet
