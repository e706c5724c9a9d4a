#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/fleet/changes.hpp"

namespace coast::fleet {

namespace {

/// Whether temperatures can tell a slope: every mission has one, and they differ by more than a degree.
bool tells_temperature(const Series& series) {
  constexpr std::size_t kFewest = 6;
  if (series.estimates.size() < kFewest) return false;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Estimate& e : series.estimates) {
    if (!e.temperature) return false;
    low = std::min(low, *e.temperature);
    high = std::max(high, *e.temperature);
  }
  return high - low > 1.0;
}

/// Whether a column is independent of the ones before it.
bool is_new(const Eigen::MatrixXd& X, Eigen::Index columns, const Eigen::VectorXd& column) {
  if (column.squaredNorm() == 0.0) return false;
  const Eigen::MatrixXd before = X.leftCols(columns);
  const Eigen::VectorXd rest = column - before * (before.transpose() * before).ldlt().solve(before.transpose() * column);
  return rest.squaredNorm() > 1e-8 * column.squaredNorm();
}

double entry_of(const Change& change, const Estimate& e, double mean_t) {
  switch (change.kind) {
    case ChangeKind::kStep:
      return e.t > change.t ? 1.0 : 0.0;
    case ChangeKind::kDrift:
      return e.t - mean_t;
    case ChangeKind::kGroupLevel:
      return e.groups[change.factor] == change.level ? 1.0 : 0.0;
  }
  return 0.0;
}

}  // namespace

Design design_of(const Series& series, std::size_t index, const std::vector<Change>& changes,
                 const std::vector<bool>& left_out) {
  Design design;
  for (std::size_t i = 0; i < series.estimates.size(); ++i)
    if (left_out.empty() || !left_out[i]) design.rows.push_back(i);
  const auto n = static_cast<Eigen::Index>(design.rows.size());
  Observations& o = design.observations;
  o.y.resize(n);
  o.sigma.resize(n);
  o.t.resize(n);
  const auto estimate = [&](Eigen::Index row) -> const Estimate& {
    return series.estimates[design.rows[static_cast<std::size_t>(row)]];
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    o.y[i] = estimate(i).value;
    o.sigma[i] = estimate(i).sigma;
    o.t[i] = estimate(i).t;
  }
  Eigen::MatrixXd X(n, static_cast<Eigen::Index>(2 + changes.size()));
  Eigen::Index columns = 0;
  const auto add = [&](const auto& entry) -> std::optional<Eigen::Index> {
    Eigen::VectorXd column(n);
    for (Eigen::Index i = 0; i < n; ++i) column[i] = entry(estimate(i));
    if (columns >= n || !is_new(X, columns, column)) return std::nullopt;
    X.col(columns) = column;
    return columns++;
  };
  X.col(columns++).setOnes();
  if (tells_temperature(series)) {
    for (Eigen::Index i = 0; i < n; ++i) design.mean_temperature += *estimate(i).temperature / static_cast<double>(n);
    design.temperature = add([&](const Estimate& e) { return *e.temperature - design.mean_temperature; });
  }
  const double mean_t = n > 0 ? o.t.mean() : 0.0;
  for (const Change& change : changes) {
    const bool has_part = std::ranges::find(change.units, index) != change.units.end();
    design.of_changes.push_back(has_part ? add([&](const Estimate& e) { return entry_of(change, e, mean_t); }) : std::nullopt);
  }
  o.X = X.leftCols(columns);
  return design;
}

}  // namespace coast::fleet
