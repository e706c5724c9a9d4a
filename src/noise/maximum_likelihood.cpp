#include <Eigen/Cholesky>
#include <cmath>

#include "bounded_search.hpp"
#include "coast/noise/estimators.hpp"

namespace coast::noise {

namespace {

std::vector<Interval> box_of(const Likelihood& likelihood, const std::vector<double>& start, const FixedParameters& fixed) {
  std::vector<Interval> box = likelihood.model().ranges(likelihood.scale());
  for (std::size_t i = 0; i < box.size(); ++i)
    if (!fixed.empty() && fixed[i]) box[i] = {start[i], start[i]};
  return box;
}

/// Block means hold what a process of rate beta tells as long as beta times the block is small (METHODS: 0.1 keeps 99 %).
std::size_t block_length(const SumModel& model, const std::vector<double>& u, const Likelihood& likelihood) {
  constexpr double kSlow = 0.1;
  constexpr double kFewestBlocks = 4000.0;
  double length = likelihood.samples() / kFewestBlocks;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const ParameterInfo::Kind kind = model.parameter(i).kind;
    if (kind == ParameterInfo::Kind::kPartial) return 1;
    if (kind == ParameterInfo::Kind::kRate) length = std::min(length, kSlow / (std::exp(u[i]) * likelihood.interval()));
  }
  return length < 2.0 ? 1 : static_cast<std::size_t>(length);
}

SearchResult search(const Likelihood& likelihood, const std::vector<double>& start, const std::vector<Interval>& box) {
  constexpr int kIterations = 200;
  const double gradient_tolerance = 1e-3;
  return search_within(start, box, gradient_tolerance, kIterations,
                       [&](const std::vector<double>& u, Eigen::VectorXd& gradient) {
                         const LikelihoodSlope at = likelihood.slope(u);
                         gradient = -at.gradient;
                         return -at.log_likelihood;
                       });
}

/// Gauss-Newton with Levenberg's damping, within the box.
class Polish {
 public:
  /// @param excess  of the curvature over the information, known from block means; empty: taken as none
  Polish(const Likelihood& likelihood, std::vector<Interval> box, Eigen::MatrixXd excess, Fit& fit)
      : likelihood_(likelihood), box_(std::move(box)), excess_(std::move(excess)), fit_(fit) {}

  void run(double tolerance, int steps) {
    LikelihoodSlope at = likelihood_.slope(fit_.u);
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
      LikelihoodSlope there = likelihood_.slope(next);
      ++fit_.passes;
      if (there.log_likelihood > at.log_likelihood) {
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
  static constexpr double kFarthest = 1.5;  // in a logarithm: beyond it the quadratic model is worth nothing

  [[nodiscard]] std::vector<bool> at_bounds(const Eigen::VectorXd& gradient) const {
    std::vector<bool> held(fit_.u.size());
    for (std::size_t i = 0; i < held.size(); ++i) {
      const double g = gradient(static_cast<Eigen::Index>(i));
      held[i] = box_[i].lower == box_[i].upper || (fit_.u[i] <= box_[i].lower && g <= 0.0) ||
                (fit_.u[i] >= box_[i].upper && g >= 0.0);
    }
    return held;
  }
  /// The information approximates the curvature where the model fits; along flat directions what it leaves out counts.
  [[nodiscard]] Eigen::MatrixXd curvature_at(const LikelihoodSlope& at) const {
    if (excess_.size() == 0) return at.information;
    const Eigen::MatrixXd curvature = at.information + excess_;
    return curvature.llt().info() == Eigen::Success ? curvature : at.information;
  }
  static Eigen::VectorXd proposal(const LikelihoodSlope& at, Eigen::MatrixXd curvature, const std::vector<bool>& held,
                                  double damping) {
    Eigen::VectorXd gradient = at.gradient;
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
      curvature(i, i) = (1.0 + damping) * curvature(i, i) + 1e-12;
      if (!held[static_cast<std::size_t>(i)]) continue;
      curvature.row(i).setZero();
      curvature.col(i).setZero();
      curvature(i, i) = 1.0;
      gradient(i) = 0.0;
    }
    return curvature.ldlt().solve(gradient);
  }
  [[nodiscard]] std::vector<double> moved(const Eigen::VectorXd& move) const {
    const double scale = std::min(1.0, kFarthest / std::max(move.cwiseAbs().maxCoeff(), 1e-300));
    std::vector<double> next = fit_.u;
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = std::clamp(next[i] + scale * move(static_cast<Eigen::Index>(i)), box_[i].lower, box_[i].upper);
    return next;
  }

  const Likelihood& likelihood_;
  std::vector<Interval> box_;
  Eigen::MatrixXd excess_;
  Fit& fit_;
};

/// Minus the Hessian by central differences of the exact gradient, less the information: from a short record.
Eigen::MatrixXd excess_curvature(const Likelihood& likelihood, const std::vector<double>& u) {
  constexpr double kStep = 1e-3;
  const auto p = static_cast<Eigen::Index>(u.size());
  Eigen::MatrixXd hessian(p, p);
  std::vector<double> moved = u;
  for (Eigen::Index i = 0; i < p; ++i) {
    const auto at = static_cast<std::size_t>(i);
    moved[at] = u[at] + kStep;
    const Eigen::VectorXd above = likelihood.slope(moved).gradient;
    moved[at] = u[at] - kStep;
    hessian.col(i) = (above - likelihood.slope(moved).gradient) / (2.0 * kStep);
    moved[at] = u[at];
  }
  return -0.5 * (hessian + hessian.transpose()) - likelihood.slope(u).information;
}

}  // namespace

Fit fit_maximum_likelihood(const Likelihood& likelihood, const std::vector<double>& start,
                           const MaximumLikelihoodOptions& options) {
  const std::vector<Interval> box = box_of(likelihood, start, options.fixed);
  Fit fit;
  fit.u = start;
  for (std::size_t i = 0; i < box.size(); ++i) fit.u[i] = std::clamp(fit.u[i], box[i].lower, box[i].upper);
  const std::size_t block = options.pyramid ? block_length(likelihood.model(), fit.u, likelihood) : 1;
  Eigen::MatrixXd excess;
  if (block > 1) {
    std::vector<StaticSignal> means;
    for (const Detrended& record : likelihood.records()) means.push_back(block_means(record.signal, block));
    const Likelihood coarse(means, likelihood.model());
    fit.u = search(coarse, fit.u, box).u;
    excess = excess_curvature(coarse, fit.u);
  } else {
    const SearchResult found = search(likelihood, fit.u, box);
    fit.u = found.u;
    fit.passes += found.evaluations;
  }
  constexpr int kSteps = 60;
  Polish(likelihood, box, excess, fit).run(options.tolerance, kSteps);
  return fit;
}

}  // namespace coast::noise
