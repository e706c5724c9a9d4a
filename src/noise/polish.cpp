#include "polish.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace coast::noise {

namespace {

class Polish {
 public:
  Polish(const SlopeFunction& likelihood, const SumModel& model, std::vector<Interval> box, Eigen::MatrixXd excess, Fit& fit)
      : likelihood_(likelihood), model_(model), box_(std::move(box)), excess_(std::move(excess)), fit_(fit) {}

  void run(double tolerance, int steps, bool learns) {
    LikelihoodSlope at = likelihood_(fit_.u);
    ++fit_.passes;
    fit_.log_likelihood = at.log_likelihood;
    fit_.trace.push_back(at.log_likelihood);
    double damping = 1e-6;
    for (int step = 0; step < steps; ++step) {
      const std::vector<bool> held = at_bounds(at.gradient);
      const Eigen::MatrixXd curvature = curvature_at(at);
      const Eigen::VectorXd move = proposal(at, curvature, held, damping);
      const double promised = at.gradient.dot(move) - 0.5 * move.dot(curvature * move);
      if (promised < tolerance) {
        fit_.converged = true;
        return;
      }
      const std::vector<double> next = moved(move);
      LikelihoodSlope there = likelihood_(next);
      ++fit_.passes;
      const bool gained = there.log_likelihood > at.log_likelihood;
      if (learns && std::isfinite(there.log_likelihood))
        learn(curvature, next, at.gradient - there.gradient, held, gained ? there.information : at.information);
      if (gained) {
        damping = std::max(1e-9, 0.1 * damping);
        at = std::move(there);
        fit_.u = next;
        fit_.log_likelihood = at.log_likelihood;
        fit_.trace.push_back(at.log_likelihood);
      } else {
        damping = std::max(1e-3, 10.0 * damping);
        if (damping > 1e8) return;
      }
    }
  }

 private:
  static constexpr double kFarthest = 1.5;  // in a logarithm: beyond it the quadratic model is invalid

  [[nodiscard]] std::vector<bool> at_bounds(const Eigen::VectorXd& gradient) const {
    std::vector<bool> held(fit_.u.size());
    for (std::size_t i = 0; i < held.size(); ++i) {
      const double g = gradient(static_cast<Eigen::Index>(i));
      held[i] = box_[i].lower == box_[i].upper || (fit_.u[i] <= box_[i].lower && g <= 0.0) ||
                (fit_.u[i] >= box_[i].upper && g >= 0.0);
    }
    return held;
  }
  /// The information approximates the curvature if the model fits; along flat directions the neglected part matters.
  [[nodiscard]] Eigen::MatrixXd curvature_at(const LikelihoodSlope& at) const {
    if (excess_.size() == 0) return at.information;
    constexpr double kUnseen = 1e-6;  // the excess comes from differences and has their errors
    Eigen::MatrixXd excess = excess_;
    for (Eigen::Index i = 0; i < excess.rows(); ++i)
      if (at.information(i, i) < kUnseen) {
        excess.row(i).setZero();
        excess.col(i).setZero();
      }
    const Eigen::MatrixXd curvature = at.information + excess;
    return curvature.llt().info() == Eigen::Success ? curvature : at.information;
  }
  /// @param change      of minus the gradient, from here to `next`
  /// @param subtracted  information of the next place to start from
  void learn(const Eigen::MatrixXd& curvature, const std::vector<double>& next, Eigen::VectorXd change,
             const std::vector<bool>& held, const Eigen::MatrixXd& subtracted) {
    constexpr double kLeast = 1e-3;  // of the curvature expected along the step: else rounding, or beyond an inflection
    Eigen::VectorXd step(change.size());
    for (Eigen::Index i = 0; i < step.size(); ++i)
      step(i) = next[static_cast<std::size_t>(i)] - fit_.u[static_cast<std::size_t>(i)];
    Eigen::VectorXd expected = curvature * step;
    for (Eigen::Index i = 0; i < step.size(); ++i)
      if (held[static_cast<std::size_t>(i)]) expected(i) = change(i) = 0.0;
    const double along = step.dot(expected);
    const double found = step.dot(change);
    excess_ = curvature - subtracted;
    if (along > 0.0 && found > kLeast * along)
      excess_ += change * change.transpose() / found - expected * expected.transpose() / along;
  }
  static Eigen::VectorXd proposal(const LikelihoodSlope& at, Eigen::MatrixXd curvature, const std::vector<bool>& held,
                                  double damping) {
    Eigen::VectorXd gradient = at.gradient;
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
      curvature(i, i) = (1.0 + damping) * curvature(i, i) + std::numeric_limits<double>::min();
      if (!held[static_cast<std::size_t>(i)]) continue;
      curvature.row(i).setZero();
      curvature.col(i).setZero();
      curvature(i, i) = 1.0;
      gradient(i) = 0.0;
    }
    return curvature.ldlt().solve(gradient);
  }
  /// A variance far from its optimum moves in its own value, not its logarithm: near zero the likelihood is a parabola
  /// of the value, and if its maximum is below zero the variance is zero.
  [[nodiscard]] std::vector<double> moved(const Eigen::VectorXd& move) const {
    const auto far_variance = [&](std::size_t i) {
      return std::abs(move(static_cast<Eigen::Index>(i))) > kFarthest &&
             model_.parameter(i).kind == ParameterInfo::Kind::kVariance;
    };
    double longest = kFarthest;
    for (std::size_t i = 0; i < fit_.u.size(); ++i)
      if (!far_variance(i)) longest = std::max(longest, std::abs(move(static_cast<Eigen::Index>(i))));
    std::vector<double> next = fit_.u;
    for (std::size_t i = 0; i < next.size(); ++i) {
      const double m = move(static_cast<Eigen::Index>(i));
      const double to =
          far_variance(i) ? (m > 0.0 ? next[i] + std::log1p(m) : box_[i].lower) : next[i] + kFarthest / longest * m;
      next[i] = std::clamp(to, box_[i].lower, box_[i].upper);
    }
    return next;
  }

  const SlopeFunction& likelihood_;
  const SumModel& model_;
  std::vector<Interval> box_;
  Eigen::MatrixXd excess_;
  Fit& fit_;
};

}  // namespace

std::vector<Interval> box_of(const Likelihood& likelihood, const std::vector<double>& start, const FixedParameters& fixed) {
  std::vector<Interval> box = likelihood.model().ranges(likelihood.scale());
  for (std::size_t i = 0; i < box.size(); ++i)
    if (!fixed.empty() && fixed[i]) box[i] = {start[i], start[i]};
  return box;
}

void polish(const SlopeFunction& likelihood, const SumModel& model, const std::vector<Interval>& box,
            const Eigen::MatrixXd& excess, const PolishOptions& options, Fit& fit) {
  Polish(likelihood, model, box, excess, fit).run(options.tolerance, options.steps, options.learns);
}

Eigen::MatrixXd excess_curvature(const SlopeFunction& likelihood, const std::vector<double>& u) {
  constexpr double kStep = 1e-3;
  const auto p = static_cast<Eigen::Index>(u.size());
  Eigen::MatrixXd hessian(p, p);
  std::vector<double> moved = u;
  for (Eigen::Index i = 0; i < p; ++i) {
    const auto at = static_cast<std::size_t>(i);
    moved[at] = u[at] + kStep;
    const Eigen::VectorXd above = likelihood(moved).gradient;
    moved[at] = u[at] - kStep;
    hessian.col(i) = (above - likelihood(moved).gradient) / (2.0 * kStep);
    moved[at] = u[at];
  }
  return -0.5 * (hessian + hessian.transpose()) - likelihood(u).information;
}

}  // namespace coast::noise
