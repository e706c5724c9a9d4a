#include <cmath>

#include "coast/noise/uncertainty.hpp"
#include "polish.hpp"
#include "short_likelihood.hpp"

namespace coast::noise {

namespace {

constexpr double kRoot95 = 1.959963984540054;  // square root of the 95 % quantile of chi2(1)

/// The signed root of the likelihood ratio along one parameter, the others maximised over.
class Profile {
 public:
  Profile(const Likelihood& likelihood, const Fit& top, std::size_t which, double direction)
      : likelihood_(likelihood), top_(top), which_(which), direction_(direction), nuisance_(top.u) {}

  /// sqrt(2 (max - profile)) at `distance` from the maximum.
  double root_at(double distance) {
    FixedParameters fixed(top_.u.size(), false);
    fixed[which_] = true;
    Fit fit;
    fit.u = nuisance_;
    fit.u[which_] = top_.u[which_] + direction_ * distance;
    const std::vector<Interval> box = box_of(likelihood_, fit.u, fixed);
    constexpr double kTolerance = 1e-4;
    polish([this](const std::vector<double>& u) { return likelihood_.slope(u); }, box, {}, kTolerance, fit);
    nuisance_ = fit.u;
    return std::sqrt(2.0 * std::max(0.0, top_.log_likelihood - fit.log_likelihood));
  }

 private:
  const Likelihood& likelihood_;
  const Fit& top_;
  std::size_t which_;
  double direction_;
  std::vector<double> nuisance_;
};

/// The distance at which the root is 1.96, by steps in proportion (the root is a straight line where the likelihood is a
/// parabola), kept between what is known to be too near and too far.
std::optional<double> crossing(Profile profile, double guess, double farthest) {
  constexpr int kSteps = 25;
  constexpr double kClose = 0.01;
  double near = 0.0;
  std::optional<double> far;
  double distance = std::min(guess, farthest);
  for (int step = 0; step < kSteps; ++step) {
    const double root = profile.root_at(distance);
    if (std::abs(root - kRoot95) < kClose) return distance;
    if (root < kRoot95) {
      if (distance >= farthest) return {};
      near = distance;
    } else {
      far = distance;
    }
    const double proportional = distance * kRoot95 / std::max(root, 0.1);
    if (!far)
      distance = std::min({std::max(proportional, 1.1 * distance), 3.0 * distance, farthest});
    else
      distance = proportional > near && proportional < *far ? proportional : 0.5 * (near + *far);
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
  if (is_long && sd < kSharp) return {fit.u[which] - kRoot95 * sd, fit.u[which] + kRoot95 * sd};

  // What is known badly is slow, and block means hold it.
  constexpr double kEnough = 8000.0;
  const std::optional<Likelihood> means = is_long ? on_block_means(likelihood, kEnough) : std::nullopt;
  const Likelihood& coarse = means ? *means : likelihood;
  Fit top;
  top.u = fit.u;
  polish([&](const std::vector<double>& u) { return coarse.slope(u); }, box_of(coarse, top.u, {}), {}, 1e-6, top);

  const Interval range = likelihood.model().ranges(likelihood.scale())[which];
  const double guess = std::isfinite(sd) ? std::clamp(kRoot95 * sd, 0.01, 2.0) : 1.0;
  ProfileInterval interval;
  if (const auto below = crossing(Profile(coarse, top, which, -1.0), guess, top.u[which] - range.lower))
    interval.lower = fit.u[which] - *below;
  if (const auto above = crossing(Profile(coarse, top, which, 1.0), guess, range.upper - top.u[which]))
    interval.upper = fit.u[which] + *above;
  return interval;
}

}  // namespace coast::noise
