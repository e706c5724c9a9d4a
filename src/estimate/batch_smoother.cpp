#include "coast/estimate/batch_smoother.hpp"

#include <cmath>
#include <stdexcept>

#include "batch_problem.hpp"
#include "coast/estimate/sparse_cholesky.hpp"
#include "coast/record/error.hpp"

namespace coast::estimate {

double RobustLoss::value(double u2) const {
  const double c2 = scale * scale;
  switch (kind) {
    case Kind::kSquared:
      return u2;
    case Kind::kHuber:
      return u2 <= c2 ? u2 : 2.0 * scale * std::sqrt(u2) - c2;
    case Kind::kCauchy:
      return c2 * std::log1p(u2 / c2);
    case Kind::kGemanMcClure:
      return u2 / (1.0 + u2 / c2);
  }
  return u2;
}

double RobustLoss::weight(double u2) const {
  const double c2 = scale * scale;
  const double cauchy = 1.0 / (1.0 + u2 / c2);
  switch (kind) {
    case Kind::kSquared:
      return 1.0;
    case Kind::kHuber:
      return u2 <= c2 ? 1.0 : scale / std::sqrt(u2);
    case Kind::kCauchy:
      return cauchy;
    case Kind::kGemanMcClure:
      return cauchy * cauchy;
  }
  return 1.0;
}

namespace {

// Mean square of a step in the metric of the normal equations. The step after this would be its square; rounding of
// coordinates (1e-9 m, against 1e-5 m of driving noise between knots) keeps it above 1e-9.
constexpr double kRest = 1e-7;

std::vector<SmoothedKnot> with_covariances(BatchProblem& problem, const BatchStates& states, const SelectedInverse& inverse,
                                           const KnotSampling& sampling) {
  std::vector<SmoothedKnot> knots(states.nav.size());
  for (std::size_t i = 0; i < knots.size(); ++i) {
    SmoothedKnot& knot = knots[i];
    knot.nav = states.nav[i];
    const std::optional<geo::GpsTime> previous = i > 0 ? std::optional(states.nav[i - 1].t) : std::nullopt;
    const bool with_states = sampling.takes(previous, knot.nav.t);
    const Eigen::MatrixXd P = with_states ? problem.covariance(i, inverse) : problem.nav_covariance(i, inverse);
    knot.cov = nav_covariance_n(P.topLeftCorner<kNav, kNav>(), knot.nav.r_eb_e);
    if (!with_states) continue;
    knot.x = states.x[i];
    knot.sd = P.diagonal().cwiseMax(0.0).cwiseSqrt();
  }
  return knots;
}

}  // namespace

BatchSolution smooth_batch(const Mission& mission, const StateLayout& layout, const FilterOptions& options,
                           const FilterState& start, const KnotStore& knots, const std::vector<KnotMeasurement>& measurements,
                           const BatchOptions& batch, const std::function<void(double)>& progress,
                           const KnotSampling& states_kept) {
  if (mission.carrier != nullptr)
    throw std::invalid_argument("smooth_batch: carrier-phase observations; their ambiguities are filtered, take the smoother");
  BatchProblem problem(mission, layout, options, start, knots, measurements, batch);
  BatchStates states = problem.filtered();
  BatchSolution solution;
  BatchReport& report = solution.report;
  SparseCholesky factor(problem.normal());
  for (int i = 0; i < batch.most_iterations && !report.converged; ++i) {
    report.cost.push_back(problem.linearise(states));
    factor.factorize(problem.normal());
    const Eigen::VectorXd d = factor.solve(problem.right());
    if (!d.allFinite())
      throw NumericalError("batch solution is not finite", geo::to_string(start.nav.t), "the forward filter has diverged");
    problem.remove(d, states);
    report.converged = d.dot(problem.right()) < kRest * static_cast<double>(d.size());
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(batch.most_iterations));
  }
  problem.forget_normal();
  report.condition = factor.condition();
  const SelectedInverse inverse = factor.invert();
  solution.smoothed = with_covariances(problem, states, inverse, states_kept);
  solution.weights = problem.weights();
  const std::size_t middle = knots.size() / 2;
  report.unknowns = mission_unknowns(layout, problem.unknown_once(), start.P,
                                     {states.nav[middle], states.x[middle], problem.covariance(middle, inverse)});
  if (progress) progress(1.0);
  return solution;
}

}  // namespace coast::estimate
