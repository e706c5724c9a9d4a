#include <cmath>

#include "coast/noise/uncertainty.hpp"
#include "polish.hpp"
#include "short_likelihood.hpp"

namespace coast::noise {

namespace {

constexpr double kProfileRoot95 = 1.959963984540054;  // square root of the 95 % quantile of chi2(1)

/// The signed root of the likelihood ratio along one parameter, the others maximised over.
class Profile {
 public:
  /// @param tangent  of the others as they follow `which` near the maximum
  Profile(const Likelihood& likelihood, const Fit& top, std::size_t which, double direction, const Eigen::VectorXd& tangent)
      : likelihood_(likelihood), top_(top), which_(which), direction_(direction), tangent_(tangent), nuisance_(top.u) {}

  /// sqrt(2 (max - profile)) at `distance` from the maximum.
  double root_at(double distance) {
    FixedParameters fixed(top_.u.size(), false);
    fixed[which_] = true;
    Fit fit;
    fit.u = nuisance_;
    constexpr double kFarthest = 0.7;  // a tangent is trusted for a factor of two
    const double ahead = direction_ * (distance - distance_);
    for (std::size_t i = 0; i < fit.u.size(); ++i)
      fit.u[i] += std::clamp(ahead * tangent_(static_cast<Eigen::Index>(i)), -kFarthest, kFarthest);
    fit.u[which_] = top_.u[which_] + direction_ * distance;
    const std::vector<Interval> box = box_of(likelihood_, fit.u, fixed);
    for (std::size_t i = 0; i < box.size(); ++i) fit.u[i] = std::clamp(fit.u[i], box[i].lower, box[i].upper);
    constexpr double kTolerance = 5e-4;  // of log-likelihood: 3e-4 of the root
    polish([this](const std::vector<double>& u) { return likelihood_.slope(u); }, likelihood_.model(), box, {},
           {.tolerance = kTolerance}, fit);
    nuisance_ = fit.u;
    distance_ = distance;
    return std::sqrt(2.0 * std::max(0.0, top_.log_likelihood - fit.log_likelihood));
  }

 private:
  const Likelihood& likelihood_;
  const Fit& top_;
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

/// Where the root is 1.96, by what was found at up to two distances: the root is a straight line where the likelihood is a
/// parabola, and bends a little where it is not: r = a d + b d^2.
class RootCurve {
 public:
  double next(double distance, double root) {
    const double slope = std::max(root, 0.1) / distance;
    const double bend = last_ > 0.0 && last_ != distance ? (slope - slope_) / (distance - last_) : 0.0;
    const double start = slope - bend * distance;
    last_ = distance;
    slope_ = slope;
    const double square = start * start + 4.0 * bend * kProfileRoot95;
    const double bent = square >= 0.0 ? 2.0 * kProfileRoot95 / (start + std::sqrt(square)) : -1.0;
    return bent > 0.0 && std::isfinite(bent) ? bent : kProfileRoot95 / slope;
  }

 private:
  double last_ = 0.0;
  double slope_ = 0.0;  ///< r/d there
};

/// The distance at which the root is 1.96, kept between what is known to be too near and too far.
std::optional<double> crossing(Profile profile, double guess, double farthest) {
  constexpr int kSteps = 25;
  constexpr double kClose = 0.01;
  RootCurve curve;
  double near = 0.0;
  std::optional<double> far;
  double distance = std::min(guess, farthest);
  for (int step = 0; step < kSteps; ++step) {
    const double root = profile.root_at(distance);
    if (std::abs(root - kProfileRoot95) < kClose) return distance;
    if (root < kProfileRoot95) {
      if (distance >= farthest) return {};
      near = distance;
    } else {
      far = distance;
    }
    const double expected = curve.next(distance, root);
    if (!far)
      distance = std::min({std::max(expected, 1.1 * distance), 3.0 * distance, farthest});
    else
      distance = expected > near && expected < *far ? expected : 0.5 * (near + *far);
    if (far && *far - near < 1e-3 * *far) return distance;
  }
  return far ? std::optional(distance) : std::nullopt;
}

}  // namespace

ProfileInterval profile_interval(const Likelihood& likelihood, const Fit& fit, std::size_t which) {
  const auto at = static_cast<Eigen::Index>(which);
  const double sd = std::sqrt(cramer_rao(likelihood.slope(fit.u).information)(at, at));
  // What is known well has a parabola for its logarithm, and of a long record block means no longer hold all of it.
  constexpr double kManySamples = 40000.0;
  constexpr double kSharp = 0.05;
  const bool is_long = likelihood.samples() > kManySamples;
  if (is_long && sd < kSharp) return {fit.u[which] - kProfileRoot95 * sd, fit.u[which] + kProfileRoot95 * sd};

  // What is known badly is slow, and block means hold it.
  constexpr double kEnough = 8000.0;
  const std::optional<Likelihood> means = is_long ? on_block_means(likelihood, kEnough) : std::nullopt;
  const Likelihood& coarse = means ? *means : likelihood;
  Fit top;
  top.u = fit.u;
  polish([&](const std::vector<double>& u) { return coarse.slope(u); }, likelihood.model(), box_of(coarse, top.u, {}), {},
         {.tolerance = 1e-6}, top);

  const Interval range = likelihood.model().ranges(likelihood.scale())[which];
  const double guess = std::isfinite(sd) ? std::clamp(kProfileRoot95 * sd, 0.01, 2.0) : 1.0;
  const Eigen::VectorXd tangent = tangent_of(coarse.slope(top.u).information, which);
  ProfileInterval interval;
  if (const auto below = crossing(Profile(coarse, top, which, -1.0, tangent), guess, top.u[which] - range.lower))
    interval.lower = fit.u[which] - *below;
  if (const auto above = crossing(Profile(coarse, top, which, 1.0, tangent), guess, range.upper - top.u[which]))
    interval.upper = fit.u[which] + *above;
  return interval;
}

}  // namespace coast::noise
