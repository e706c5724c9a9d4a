#include <cmath>
#include <optional>

#include "bounded_search.hpp"
#include "coast/noise/estimators.hpp"
#include "polish.hpp"

namespace coast::noise {

namespace {

constexpr double kNear = 3.0;  // of log-likelihood: a start further below before it is polished does not become the best

/// Variances that start near zero are raised until the likelihood's slope in their logarithm differs from zero: near
/// zero every start is a stationary point.
void lift_from_zero(const Likelihood& likelihood, const std::vector<Interval>& box, std::vector<double>& u) {
  constexpr double kNothing = 15.0;  // the range spans 42
  constexpr double kSmall = 15.0;    // below the upper end: 3e-4 of the signal
  for (std::size_t i = 0; i < u.size(); ++i)
    if (likelihood.model().parameter(i).kind == ParameterInfo::Kind::kVariance && u[i] < box[i].lower + kNothing)
      u[i] = std::clamp(box[i].upper - kSmall, box[i].lower, box[i].upper);
}

/// A start independent of the given one: rates equally spaced, in logarithms, over the record's range. None
/// with fewer than two rates: such sums usually have one maximum, larger ones may have another in which two processes share the
/// part of one.
std::optional<std::vector<double>> spread_start(const SumModel& model, const std::vector<Interval>& box,
                                                std::vector<double> u) {
  std::vector<std::size_t> rates;
  for (std::size_t i = 0; i < u.size(); ++i)
    if (model.parameter(i).kind == ParameterInfo::Kind::kRate && box[i].lower < box[i].upper) rates.push_back(i);
  if (rates.size() < 2) return {};
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const Interval& range = box[rates[k]];
    const double along = static_cast<double>(k + 1) / static_cast<double>(rates.size() + 1);
    u[rates[k]] = range.lower + along * (range.upper - range.lower);
  }
  return u;
}

/// The maximisation, on an approximation of a long record and then on all of it.
class Ascent {
 public:
  Ascent(const Likelihood& likelihood, std::vector<Interval> box, const MaximumLikelihoodOptions& options)
      : likelihood_(likelihood), shortened_(likelihood), box_(std::move(box)), options_(options) {}

  [[nodiscard]] Fit from(const std::vector<double>& start);

 private:
  [[nodiscard]] bool is_long() const { return options_.pyramid && !shortened_.is_whole(); }
  template <class Of>
  [[nodiscard]] SearchResult search(const Of& of, const std::vector<double>& start) const;
  void on_stand_in(Fit& fit);
  void finish(Fit& fit) const;
  void try_without(Fit& fit) const;
  void try_elsewhere(Fit& fit) const;

  const Likelihood& likelihood_;
  ShortLikelihood shortened_;
  std::vector<Interval> box_;
  const MaximumLikelihoodOptions& options_;
  Eigen::MatrixXd excess_;
};

template <class Of>
SearchResult Ascent::search(const Of& of, const std::vector<double>& start) const {
  constexpr int kIterations = 30;
  constexpr double kGradient = 1e-3;
  return search_within(start, box_, kGradient, kIterations, [&](const std::vector<double>& u, Eigen::VectorXd& gradient) {
    const LikelihoodSlope at = of.slope(u);
    gradient = -at.gradient;
    return -at.log_likelihood;
  });
}

void Ascent::on_stand_in(Fit& fit) {
  constexpr int kSteps = 12;
  constexpr double kTolerance = 1e-5;
  const auto slope = [&](const std::vector<double>& u) { return shortened_.slope(u); };
  fit.u = search(shortened_, fit.u).u;
  polish(slope, likelihood_.model(), box_, {}, {.tolerance = kTolerance, .steps = kSteps}, fit);
  fit.trace.clear();
  fit.passes = 0;
  excess_ = excess_curvature(slope, fit.u);
}

/// If the information is a poor approximation of the curvature, along a flat ridge, the steps get too short; then the curvature
/// itself is used.
void Ascent::finish(Fit& fit) const {
  const auto slope = [&](const std::vector<double>& u) { return likelihood_.slope(u); };
  polish(slope, likelihood_.model(), box_, excess_, {.tolerance = options_.tolerance}, fit);
  if (fit.converged) return;
  const Eigen::MatrixXd excess = excess_curvature(slope, fit.u);
  fit.passes += static_cast<int>(2 * fit.u.size() + 1);
  polish(slope, likelihood_.model(), box_, excess, {.tolerance = options_.tolerance}, fit);
}

void take_if_better(const Fit& other, Fit& fit) {
  fit.passes += other.passes;
  if (!(other.log_likelihood > fit.log_likelihood)) return;
  fit.u = other.u;
  fit.log_likelihood = other.log_likelihood;
  fit.converged = other.converged;
  fit.trace.push_back(other.log_likelihood);
}

/// A likelihood may have a second maximum without one of the processes. If the sum without it is nearly as likely, its maximum
/// is tried as a start too.
void Ascent::try_without(Fit& fit) const {
  for (std::size_t i = 0; i < box_.size(); ++i) {
    if (likelihood_.model().parameter(i).kind != ParameterInfo::Kind::kVariance || fit.u[i] <= box_[i].lower) continue;
    Fit other;
    other.u = fit.u;
    other.u[i] = box_[i].lower;
    ++fit.passes;
    if (likelihood_.value(other.u).log_likelihood < fit.log_likelihood - kNear) continue;
    finish(other);
    take_if_better(other, fit);
  }
}

void Ascent::try_elsewhere(Fit& fit) const {
  const auto elsewhere = spread_start(likelihood_.model(), box_, fit.u);
  if (!elsewhere) return;
  Fit other;
  other.u = search(shortened_, *elsewhere).u;
  if (shortened_.value(other.u) < shortened_.value(fit.u) - kNear) return;
  finish(other);
  take_if_better(other, fit);
}

Fit Ascent::from(const std::vector<double>& start) {
  Fit fit;
  fit.u = start;
  for (std::size_t i = 0; i < box_.size(); ++i) fit.u[i] = std::clamp(fit.u[i], box_[i].lower, box_[i].upper);
  lift_from_zero(likelihood_, box_, fit.u);
  if (is_long()) {
    on_stand_in(fit);
  } else {
    const SearchResult found = search(likelihood_, fit.u);
    fit.u = found.u;
    fit.passes += found.evaluations;
    for (const double value : found.trace) fit.trace.push_back(-value);
  }
  if (!options_.polished) {
    fit.log_likelihood = shortened_.value(fit.u);
    return fit;
  }
  finish(fit);
  try_without(fit);
  try_elsewhere(fit);
  return fit;
}

}  // namespace

Fit fit_maximum_likelihood(const Likelihood& likelihood, const std::vector<double>& start,
                           const MaximumLikelihoodOptions& options) {
  return Ascent(likelihood, box_of(likelihood, start, options.fixed), options).from(start);
}

}  // namespace coast::noise
