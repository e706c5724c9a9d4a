
#include <cmath>

#include "coast/noise/uncertainty.hpp"
#include "coast/parallel.hpp"
#include "polish.hpp"
#include "profile_search.hpp"
#include "short_likelihood.hpp"
#include "spectrum.hpp"

namespace coast::noise {

namespace {

/// A likelihood to be profiled, and its maximum.
class Followed {
 public:
  Followed(SlopeFunction slope, const SumModel& model, const SignalScale& scale, const std::vector<double>& start)
      : slope_(std::move(slope)), model_(model), ranges_(model.ranges(scale)) {
    top_.u = start;
    polish(slope_, model_, ranges_, {}, {.tolerance = 1e-6}, top_);
    information_ = slope_(top_.u).information;
  }

  [[nodiscard]] const Fit& top() const { return top_; }
  [[nodiscard]] const Eigen::MatrixXd& information() const { return information_; }
  [[nodiscard]] const Interval& range(std::size_t i) const { return ranges_[i]; }
  /// Maximised over all but one parameter, which is at `value`. @param u  start in, maximum out
  [[nodiscard]] double maximum(std::size_t which, double value, std::vector<double>& u) const {
    constexpr double kTolerance = 5e-4;  // of log-likelihood: 3e-4 of the root
    std::vector<Interval> box = ranges_;
    box[which] = {value, value};
    Fit fit;
    for (std::size_t i = 0; i < u.size(); ++i) fit.u.push_back(std::clamp(u[i], box[i].lower, box[i].upper));
    polish(slope_, model_, box, {}, {.tolerance = kTolerance}, fit);
    u = fit.u;
    return fit.log_likelihood;
  }

 private:
  SlopeFunction slope_;
  const SumModel& model_;
  std::vector<Interval> ranges_;
  Fit top_;
  Eigen::MatrixXd information_;
};

/// The signed root of the likelihood ratio along one parameter, the others maximised over.
class Profile {
 public:
  /// @param tangent  of the others as functions of `which` near the maximum
  Profile(const Followed& likelihood, std::size_t which, double direction, const Eigen::VectorXd& tangent)
      : likelihood_(likelihood), which_(which), direction_(direction), tangent_(tangent), nuisance_(likelihood.top().u) {}

  /// sqrt(2 (max - profile)) at `distance` from the maximum.
  double root_at(double distance) {
    constexpr double kFarthest = 0.7;  // the tangent is valid for a factor of two
    const double ahead = direction_ * (distance - distance_);
    for (std::size_t i = 0; i < nuisance_.size(); ++i)
      nuisance_[i] += std::clamp(ahead * tangent_(static_cast<Eigen::Index>(i)), -kFarthest, kFarthest);
    const double value = likelihood_.maximum(which_, likelihood_.top().u[which_] + direction_ * distance, nuisance_);
    distance_ = distance;
    return std::sqrt(2.0 * std::max(0.0, likelihood_.top().log_likelihood - value));
  }

 private:
  const Followed& likelihood_;
  std::size_t which_;
  double direction_;
  Eigen::VectorXd tangent_;
  std::vector<double> nuisance_;  ///< at distance_
  double distance_ = 0.0;
};

/// d u_i / d u_which along the maxima over the others, by the information.
Eigen::VectorXd tangent_of(const Eigen::MatrixXd& information, std::size_t which) {
  const auto w = static_cast<Eigen::Index>(which);
  const Eigen::VectorXd column = cramer_rao(information).col(w);
  Eigen::VectorXd tangent = column / column(w);
  for (double& slope : tangent)
    if (!std::isfinite(slope)) slope = 0.0;
  return tangent;
}

/// About `at`, with the width of the interval about the maximum of the profiled likelihood.
ProfileInterval interval_about(double at, const Followed& likelihood, std::size_t which, double sd) {
  const double top = likelihood.top().u[which];
  const Interval& range = likelihood.range(which);
  const double guess = std::isfinite(sd) ? std::clamp(kProfileRoot95 * sd, 0.01, 2.0) : 1.0;
  const Eigen::VectorXd tangent = tangent_of(likelihood.information(), which);
  ProfileInterval interval;
  Profile down(likelihood, which, -1.0, tangent);
  Profile up(likelihood, which, 1.0, tangent);
  if (const auto below = crossing([&](double d) { return down.root_at(d); }, guess, top - range.lower))
    interval.lower = at - *below;
  if (const auto above = crossing([&](double d) { return up.root_at(d); }, guess, range.upper - top))
    interval.upper = at + *above;
  return interval;
}

/// The likelihoods used for the intervals of a long record.
class Extracts {
 public:
  Extracts(const Likelihood& likelihood, const Fit& fit) {
    constexpr double kEnough = 8000.0;
    const SumModel& model = likelihood.model();
    if (const std::optional<Likelihood> means = on_block_means(likelihood, kEnough))
      on_means_.emplace([means = *means](const std::vector<double>& u) { return means.slope(u); }, model, likelihood.scale(),
                        fit.u);
    on_spectrum_.emplace([spectrum = spectrum_of(likelihood.records()),
                          &model](const std::vector<double>& u) { return spectral_slope(spectrum, model, u); },
                         model, likelihood.scale(), fit.u);
  }
  [[nodiscard]] const Followed& of(std::size_t which, const Eigen::MatrixXd& information) const {
    constexpr double kHalf = 0.5;
    const auto i = static_cast<Eigen::Index>(which);
    return on_means_ && on_means_->top().converged && on_means_->information()(i, i) > kHalf * information(i, i)
               ? *on_means_
               : *on_spectrum_;
  }

 private:
  std::optional<Followed> on_means_;
  std::optional<Followed> on_spectrum_;
};

}  // namespace

std::vector<ProfileInterval> profile_intervals(const Likelihood& likelihood, const Fit& fit) {
  constexpr double kManySamples = 40000.0;
  constexpr double kSharp = 0.05;
  std::vector<ProfileInterval> intervals(fit.u.size());
  const auto sd_of = [](const Eigen::MatrixXd& covariance, std::size_t i) {
    return std::sqrt(covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)));
  };
  if (likelihood.samples() <= kManySamples) {
    const Followed whole([&](const std::vector<double>& u) { return likelihood.slope(u); }, likelihood.model(),
                         likelihood.scale(), fit.u);
    const Eigen::MatrixXd covariance = cramer_rao(whole.information());
    coast::parallel_for(std::size_t{0}, intervals.size(),
                        [&](std::size_t i) { intervals[i] = interval_about(fit.u[i], whole, i, sd_of(covariance, i)); });
    return intervals;
  }
  const Eigen::MatrixXd information = likelihood.slope(fit.u).information;
  const Eigen::MatrixXd covariance = cramer_rao(information);
  const Extracts extracts(likelihood, fit);
  coast::parallel_for(std::size_t{0}, intervals.size(), [&](std::size_t i) {
    const double sd = sd_of(covariance, i);
    // A well-known parameter has a parabolic log-likelihood, and an extract has only part of a long record's information.
    if (sd < kSharp)
      intervals[i] = {fit.u[i] - kProfileRoot95 * sd, fit.u[i] + kProfileRoot95 * sd};
    else
      intervals[i] = interval_about(fit.u[i], extracts.of(i, information), i, sd);
  });
  return intervals;
}

}  // namespace coast::noise
