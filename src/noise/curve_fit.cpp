#include <Eigen/Cholesky>
#include <cmath>

#include "bounded_search.hpp"
#include "coast/noise/estimators.hpp"

namespace coast::noise {

namespace {

/// A curve to be matched: variances at averaging times, with the standard deviation of each.
struct Target {
  double interval = 1.0;  ///< s between samples
  Eigen::VectorXd tau;
  Eigen::VectorXd variance;
  Eigen::VectorXd sd;
};

Target target_of(const AllanCurve& curve, double interval, CurveFit kind) {
  std::vector<const AllanPoint*> points;
  std::uint64_t next = 0;
  for (const AllanPoint& point : curve) {
    if (!(point.allan.value > 0.0) || (kind == CurveFit::kAllan && point.factor < next)) continue;
    points.push_back(&point);
    next = 2 * point.factor;
  }
  const auto n = static_cast<Eigen::Index>(points.size());
  Target target{interval, Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const AllanPoint& point = *points[static_cast<std::size_t>(i)];
    target.tau(i) = point.tau;
    target.variance(i) = point.allan.value * point.allan.value;
    // A chi-square's relative deviation; equal weights for the classical fit.
    target.sd(i) = target.variance(i) * (kind == CurveFit::kAllan ? 1.0 : std::sqrt(2.0 / std::max(point.allan.edf, 1.0)));
  }
  return target;
}

/// Positions of the terms' variance and rates in u.
struct Roles {
  std::vector<std::size_t> scales;  ///< one per term
  std::vector<std::size_t> rates;
};
Roles roles_of(const SumModel& model) {
  Roles roles;
  for (std::size_t i = 0; i < model.parameters(); ++i)
    (model.parameter(i).kind == ParameterInfo::Kind::kVariance ? roles.scales : roles.rates).push_back(i);
  return roles;
}

/// Curves of the terms with unit variance, one column per term.
Eigen::MatrixXd unit_curves(const SumModel& model, const Roles& roles, const std::vector<double>& rates, const Target& target) {
  Eigen::MatrixXd columns(target.tau.size(), static_cast<Eigen::Index>(roles.scales.size()));
  std::vector<double> u = rates;
  for (const std::size_t i : roles.scales) u[i] = 0.0;
  const std::vector<ProcessPtr> processes = model.processes(u, {Sensor::kGyro, target.interval});
  for (Eigen::Index j = 0; j < columns.cols(); ++j)
    for (Eigen::Index i = 0; i < columns.rows(); ++i)
      columns(i, j) = processes[static_cast<std::size_t>(j)]->allan_variance(target.tau(i)).value_or(0.0);
  return columns;
}

/// Non-negative least squares by trying all sets of zero columns: there are few columns.
struct NonNegative {
  Eigen::VectorXd x;
  double cost = std::numeric_limits<double>::infinity();
};
NonNegative non_negative_fit(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  const Eigen::Index n = A.cols();
  const Eigen::VectorXd norms = A.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd unit = A * norms.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd normal = unit.transpose() * unit;
  const Eigen::VectorXd right = unit.transpose() * b;
  NonNegative best;
  for (unsigned subset = 1; subset < (1U << static_cast<unsigned>(n)); ++subset) {
    std::vector<Eigen::Index> in;
    for (Eigen::Index j = 0; j < n; ++j)
      if ((subset >> static_cast<unsigned>(j) & 1U) != 0) in.push_back(j);
    const Eigen::VectorXd y = right(in);
    const Eigen::VectorXd x = normal(in, in).ldlt().solve(y);
    if (!(x.minCoeff() > 0.0)) continue;
    const double cost = b.squaredNorm() - x.dot(y);
    if (cost >= best.cost) continue;
    best.cost = cost;
    best.x = Eigen::VectorXd::Zero(n);
    best.x(in) = x;
  }
  if (best.x.size() == 0) best.x = Eigen::VectorXd::Zero(n);  // a curve of zeros, or of no points: no column helps
  best.x = best.x.cwiseQuotient(norms);
  return best;
}

/// Rates over a logarithmic grid: ascending for adjacent rates of the same process, so that no combination occurs twice. If
/// there are many rates, or partial autocorrelations, whose curves cost more, one at a time is moved over its grid.
class RateGrid {
 public:
  RateGrid(const SumModel& model, const Roles& roles, const std::vector<Interval>& ranges, const Target& target)
      : model_(model), roles_(roles), ranges_(ranges), target_(target) {
    weighted_ = target.variance.cwiseQuotient(target.sd);
  }
  std::vector<double> best() {
    std::vector<double> u(model_.parameters());
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = ranges_[i].lower;
    best_ = u;
    if (combinations() <= kTogether) {
      vary(0, 0, u);
      return best_;
    }
    for (const std::size_t i : roles_.rates) u[i] = on_grid(i, kPoints / 2);
    try_variances(u);
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (std::size_t which = 0; which < roles_.rates.size();) which += vary_about_best(which);
    return best_;
  }

 private:
  static constexpr int kPoints = 14;
  static constexpr double kTogether = 6000.0;  // combinations
  static constexpr int kSweeps = 3;

  [[nodiscard]] double on_grid(std::size_t i, int k) const {
    if (is_partial(i)) return -2.0 + 4.0 * k / (kPoints - 1);
    return ranges_[i].lower + (ranges_[i].upper - ranges_[i].lower) * (k + 0.5) / kPoints;
  }
  [[nodiscard]] bool is_partial(std::size_t i) const { return model_.parameter(i).kind == ParameterInfo::Kind::kPartial; }
  /// For all rates: in ascending order for equal processes, any order for partial autocorrelations.
  [[nodiscard]] double combinations() const {
    double count = 1.0;
    int ascending = 0;
    for (const std::size_t i : roles_.rates) {
      count *= is_partial(i) ? kPoints : (kPoints - ascending) / (ascending + 1.0);
      if (!is_partial(i)) ++ascending;
    }
    return count;
  }
  /// One rate, or two adjacent partial autocorrelations: the frequency of a resonance depends on both.
  /// @return their number
  std::size_t vary_about_best(std::size_t which) {
    const std::vector<double> about = best_;
    const std::size_t i = roles_.rates[which];
    const bool pair = which + 1 < roles_.rates.size() && is_partial(i) && roles_.rates[which + 1] == i + 1 && is_partial(i + 1);
    for (int k = 0; k < kPoints; ++k)
      for (int l = 0; l < (pair ? kPoints : 1); ++l) {
        std::vector<double> u = about;
        u[i] = on_grid(i, k);
        if (pair) u[i + 1] = on_grid(i + 1, l);
        try_variances(u);
      }
    return pair ? 2 : 1;
  }
  void vary(std::size_t which, int from, std::vector<double>& u) {
    if (which == roles_.rates.size()) return try_variances(u);
    const std::size_t i = roles_.rates[which];
    for (int k = is_partial(i) ? 0 : from; k < kPoints; ++k) {
      u[i] = on_grid(i, k);
      vary(which + 1, is_partial(i) ? from : k + 1, u);
    }
  }
  void try_variances(std::vector<double> u) {
    const Eigen::MatrixXd A = target_.sd.cwiseInverse().asDiagonal() * unit_curves(model_, roles_, u, target_);
    const NonNegative fit = non_negative_fit(A, weighted_);
    if (!(fit.cost < cost_)) return;
    cost_ = fit.cost;
    for (std::size_t j = 0; j < roles_.scales.size(); ++j) {
      const std::size_t i = roles_.scales[j];
      const double x = fit.x(static_cast<Eigen::Index>(j));
      u[i] = x > 0.0 ? std::clamp(std::log(x), ranges_[i].lower, ranges_[i].upper) : ranges_[i].lower;
    }
    best_ = u;
  }

  const SumModel& model_;
  const Roles& roles_;
  const std::vector<Interval>& ranges_;
  const Target& target_;
  Eigen::VectorXd weighted_;
  double cost_ = std::numeric_limits<double>::infinity();
  std::vector<double> best_;
};

}  // namespace

std::vector<double> fit_curve(const AllanCurve& curve, const SumModel& model, const SignalScale& scale, CurveFit kind) {
  const Target target = target_of(curve, scale.interval, kind);
  const std::vector<Interval> ranges = model.ranges(scale);
  const Roles roles = roles_of(model);
  const std::vector<double> start = RateGrid(model, roles, ranges, target).best();
  const auto cost = [&](const std::vector<double>& u) {
    double sum = 0.0;
    const std::vector<ProcessPtr> processes = model.processes(u, {Sensor::kGyro, target.interval});
    for (Eigen::Index i = 0; i < target.tau.size(); ++i) {
      const double modelled = allan_variance(processes, target.tau(i));
      const double miss =
          kind == CurveFit::kAllan ? std::log(modelled / target.variance(i)) : (modelled - target.variance(i)) / target.sd(i);
      sum += 0.5 * miss * miss;
    }
    return sum;
  };
  constexpr double kStep = 1e-5;
  const auto with_gradient = [&](const std::vector<double>& u, Eigen::VectorXd& gradient) {
    std::vector<double> moved = u;
    for (std::size_t i = 0; i < u.size(); ++i) {
      moved[i] = u[i] + kStep;
      const double above = cost(moved);
      moved[i] = u[i] - kStep;
      gradient(static_cast<Eigen::Index>(i)) = (above - cost(moved)) / (2.0 * kStep);
      moved[i] = u[i];
    }
    return cost(u);
  };
  return search_within(start, ranges, 1e-6, 300, with_gradient).u;
}

}  // namespace coast::noise
