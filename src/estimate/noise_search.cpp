#include "noise_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <deque>

#include "coast/parallel.hpp"

namespace coast::estimate {

namespace {

using Eigen::Index;

/// Change of the slopes by a step.
struct Secant {
  Eigen::VectorXd step, fall;
};

// Broyden, Fletcher, Goldfarb and Shanno; B stays positive.
void correct(Eigen::MatrixXd& B, const Secant& secant) {
  const double curvature = secant.step.dot(secant.fall);
  const Eigen::VectorXd model_fall = B * secant.step;
  const double modelled = secant.step.dot(model_fall);
  constexpr double kLeast = 0.05;  // of the modelled change: smaller ones give no curvature
  if (!(modelled > 0.0) || curvature < kLeast * modelled) return;
  B += secant.fall * secant.fall.transpose() / curvature - model_fall * model_fall.transpose() / modelled;
}

/// For each parameter, with all others known.
Eigen::VectorXd sigmas_of_each(const Eigen::MatrixXd& information) {
  constexpr double kLeast = 1.0;
  return information.diagonal().cwiseMax(kLeast).cwiseSqrt().cwiseInverse();
}

double promised(const Eigen::VectorXd& g, const Eigen::MatrixXd& B, const Eigen::VectorXd& step) {
  return g.dot(step) - 0.5 * step.dot(B * step);
}

// A variance that is far too small gives a step of at most e times itself, however large the true one: for g = m (v'/v - 1) and
// B = m v'/v a step of s = g/B corresponds to v' = v / (1 - s).
Eigen::VectorXd lengthened(Eigen::VectorXd step, const Eigen::VectorXd& high) {
  for (Index i = 0; i < step.size(); ++i) {
    if (!(step(i) > 0.0)) continue;
    const double whole = step(i) < 0.5 ? -0.5 * std::log1p(-2.0 * step(i)) : high(i);
    step(i) = std::min(high(i), whole);
  }
  return step;
}

/// Makes the step if the likelihood does not decrease.
bool take(const Likelihood& likelihood, const Eigen::VectorXd& step, double least, SearchPoint& at) {
  const double value = likelihood.value(at.theta + step);
  if (!(value > least)) return false;
  at.theta += step;
  at.value = value;
  at.scores = likelihood.scores();
  return true;
}

/// Shorter steps until the likelihood does not decrease; false if there is none.
bool take_some(const Likelihood& likelihood, Eigen::VectorXd step, double least, SearchPoint& at) {
  constexpr int kHalvings = 6;
  for (int k = 0; k <= kHalvings; ++k, step *= 0.5)
    if (take(likelihood, step, least, at)) return true;
  return false;
}

}  // namespace

SearchPoint point_at(const Likelihood& likelihood, const Eigen::VectorXd& theta) {
  SearchPoint at{theta, likelihood.value(theta), {}, {}};
  if (!std::isfinite(at.value)) return at;
  at.scores = likelihood.scores();
  at.information = at.scores.information;
  return at;
}

Eigen::VectorXd SearchState::slopes() const {
  if (!beyond_scores) return at.scores.gradient;
  return at.scores.gradient + beyond_scores->slopes + beyond_scores->change * (at.theta - beyond_scores->at);
}

// One coordinate at a time: the function is a parabola in each.
Eigen::VectorXd best_step(const Eigen::VectorXd& g, const Eigen::MatrixXd& B, const Eigen::VectorXd& low,
                          const Eigen::VectorXd& high) {
  constexpr int kMostSweeps = 20000;
  constexpr double kStill = 1e-9;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(g.size());
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double moved = 0.0;
    for (Index i = 0; i < g.size(); ++i) {
      const double slope = g(i) - B.row(i).dot(step) + B(i, i) * step(i);
      const double best = B(i, i) > 0.0 ? slope / B(i, i) : std::copysign(high(i) - low(i), slope);
      const double there = std::clamp(best, low(i), high(i));
      moved = std::max(moved, std::abs(there - step(i)));
      step(i) = there;
    }
    if (moved < kStill) break;
  }
  return step;
}

void climb(const Likelihood& likelihood, const SearchBox& box, double settled, SearchState& state) {
  constexpr int kMostSteps = 40;
  constexpr double kFarthest = 2.0;  // a factor of 7
  constexpr double kFar = 1000.0;    // of the log-likelihood
  constexpr double kNear = 0.5;      // beyond it a secant gives no information on the curvature at its end
  constexpr double kNothing = 1e-3;  // of the log-likelihood: allowed loss of a step because of slope errors
  constexpr double kKept = 0.1;      // of a small promised gain, below which it is such an error
  SearchPoint& at = state.at;
  std::deque<Secant> secants;
  for (int i = 0; i < kMostSteps; ++i) {
    const Eigen::VectorXd low = (box.low - at.theta).cwiseMax(-kFarthest);
    const Eigen::VectorXd high = (box.high - at.theta).cwiseMin(kFarthest);
    const Eigen::VectorXd before = at.theta, slopes = state.slopes();
    const double value_before = at.value;
    const Eigen::VectorXd step = best_step(slopes, at.information, low, high);
    const double gain = promised(slopes, at.information, step);
    if (gain < settled) return;
    const bool taken = (gain > kFar && take(likelihood, lengthened(step, high), at.value, at)) ||
                       take_some(likelihood, step, at.value - kNothing, at);
    if (!taken) return;
    // Scores leave out what the linearisation point changes: near the optimum they point beside it, step after step.
    if (!state.beyond_scores && gain < kNear && at.value - value_before < kKept * gain) return;
    secants.push_back({at.theta - before, slopes - state.slopes()});
    if (secants.back().step.lpNorm<Eigen::Infinity>() > kNear) secants.clear();
    if (secants.size() > static_cast<std::size_t>(slopes.size())) secants.pop_front();
    if (!state.beyond_scores) at.information = at.scores.information;
    for (const Secant& secant : secants) correct(at.information, secant);
  }
}

namespace {

/// One-sided: the effect of the second derivative is subtracted. Second derivatives are computed too.
Eigen::VectorXd slopes_with_curvature(const Likelihood& likelihood, SearchPoint& at) {
  constexpr double kShare = 0.03;  // of a sigma
  const Index n = at.theta.size();
  const Eigen::VectorXd steps = kShare * sigmas_of_each(at.information);
  Eigen::MatrixXd information(n, n);
  Eigen::VectorXd slopes(n);
  coast::parallel_for(Index{0}, n, [&](Index i) {
    double value = 0.0;
    const NoiseScores there = likelihood.scores_beside(at.theta + steps(i) * Eigen::VectorXd::Unit(n, i), value);
    slopes(i) = (value - at.value) / steps(i);
    information.col(i) = (at.scores.gradient - there.gradient) / steps(i);
  });
  slopes += 0.5 * steps.cwiseProduct(information.diagonal());
  information = (0.5 * (information + information.transpose())).eval();
  if (information.llt().info() == Eigen::Success) at.information = information;  // else the average one, which is no saddle
  return slopes;
}

/// By central differences.
Eigen::VectorXd slopes_by_values(const Likelihood& likelihood, const SearchPoint& at) {
  constexpr double kShare = 0.1;  // rounding of a value, 1e-5, and third derivatives, 0.1 per cubed sigma, both give 2e-4
  const Index n = at.theta.size();
  const Eigen::VectorXd steps = kShare * sigmas_of_each(at.information);
  Eigen::VectorXd slopes(n);
  coast::parallel_for(Index{0}, n, [&](Index i) {
    const Eigen::VectorXd step = steps(i) * Eigen::VectorXd::Unit(n, i);
    slopes(i) = (likelihood.value_beside(at.theta + step) - likelihood.value_beside(at.theta - step)) / (2.0 * steps(i));
  });
  return slopes;
}

}  // namespace

void relinearise(const Likelihood& likelihood, bool curvature, SearchState& state) {
  SearchPoint& at = state.at;
  const Eigen::VectorXd slopes =
      (curvature ? slopes_with_curvature(likelihood, at) : slopes_by_values(likelihood, at)) - at.scores.gradient;
  Relinearised now{at.theta, slopes, Eigen::MatrixXd::Zero(slopes.size(), slopes.size())};
  if (state.beyond_scores) {       // Broyden's rule, with sigmas as units
    constexpr double kTold = 0.1;  // sigmas: below it the difference is rounding
    const Relinearised& last = *state.beyond_scores;
    const Eigen::VectorXd moved = now.at - last.at;
    const Eigen::VectorXd weighted = at.information * moved;
    now.change = last.change;
    if (const double size = moved.dot(weighted); size > kTold * kTold)
      now.change += (now.slopes - last.slopes - last.change * moved) * weighted.transpose() / size;
  }
  state.beyond_scores = std::move(now);
}

void polish(const Likelihood& likelihood, const SearchBox& box, SearchState& state) {
  constexpr int kMost = 5;
  constexpr double kSettled = 1e-7;  // of the log-likelihood: half a thousandth of a sigma
  constexpr double kLast = 5e-5;     // a hundredth: after relinearisation a tenth of it remains
  for (int i = 0; i < kMost; ++i) {
    relinearise(likelihood, i == 0, state);
    const Eigen::VectorXd step =
        best_step(state.slopes(), state.at.information, box.low - state.at.theta, box.high - state.at.theta);
    const double gain = promised(state.slopes(), state.at.information, step);
    climb(likelihood, box, kSettled, state);
    if (gain < kLast) return;
  }
}

}  // namespace coast::estimate
