#include <cmath>
#include <limits>

#include "coast/noise/uncertainty.hpp"
#include "polish.hpp"
#include "profile_search.hpp"

namespace coast::noise {

namespace {

/// One coefficient of one record's mean.
struct Place {
  std::size_t record = 0;
  Eigen::Index coefficient = 0;
};

/// The restricted log-likelihood with one coefficient held at a value, the others profiled as usual:
///
///     log L(u) - z(u)^2 / 2,    z = (value - its generalised least squares estimate at u) / standard deviation of that.
///
/// For white noise its maximum over u is -(n - 1)/2 log(sum of squares about the value): Student's t except for its quantile.
class HeldMean {
 public:
  HeldMean(const Likelihood& likelihood, Place place, double value) : likelihood_(likelihood), place_(place), value_(value) {}

  [[nodiscard]] LikelihoodSlope operator()(const std::vector<double>& u) const {
    LikelihoodSlope slope = likelihood_.slope(u);
    const double z = departure(u);
    const Eigen::VectorXd dz = departure_slope(u);
    slope.log_likelihood -= 0.5 * z * z;
    slope.gradient -= z * dz;
    // z is proportional to the root of a variance that is proportional to exp(u): z d2z equals dz dz' and adds it once more.
    slope.information += 2.0 * dz * dz.transpose();
    return slope;
  }

 private:
  [[nodiscard]] double departure(const std::vector<double>& u) const {
    const std::vector<MeanEstimate> means = likelihood_.value(u).means;
    if (means.size() <= place_.record) return std::numeric_limits<double>::infinity();
    const MeanEstimate& mean = means[place_.record];
    return (value_ - mean.value(place_.coefficient)) / std::sqrt(mean.covariance(place_.coefficient, place_.coefficient));
  }
  [[nodiscard]] Eigen::VectorXd departure_slope(const std::vector<double>& u) const {
    constexpr double kStep = 1e-3;  // of logarithms: the error is proportional to its square, 1e-6
    Eigen::VectorXd slope(static_cast<Eigen::Index>(u.size()));
    for (std::size_t i = 0; i < u.size(); ++i) {
      std::vector<double> at = u;
      at[i] = u[i] + kStep;
      const double above = departure(at);
      at[i] = u[i] - kStep;
      slope(static_cast<Eigen::Index>(i)) = (above - departure(at)) / (2.0 * kStep);
    }
    return slope;
  }

  const Likelihood& likelihood_;
  Place place_;
  double value_;
};

ProfileInterval interval_of(const Likelihood& likelihood, const Fit& top, Place place, double at) {
  constexpr double kFarthest = 50.0;   // standard deviations; practically unbounded
  constexpr double kTolerance = 5e-4;  // of log-likelihood: 3e-4 of the root
  const std::vector<Interval> ranges = likelihood.model().ranges(likelihood.scale());
  const MeanEstimate mean = likelihood.value(top.u).means.at(place.record);
  const double centre = mean.value(place.coefficient);
  const double sd = std::sqrt(mean.covariance(place.coefficient, place.coefficient));
  const auto distance = [&](double direction) {
    Fit fit = top;  // the other parameters start at their values for the previous distance
    const auto root_at = [&](double d) {
      fit.converged = false;
      polish(HeldMean(likelihood, place, centre + direction * d), likelihood.model(), ranges, {}, {.tolerance = kTolerance},
             fit);
      return std::sqrt(2.0 * std::max(0.0, top.log_likelihood - fit.log_likelihood));
    };
    return crossing(root_at, kProfileRoot95 * sd, kFarthest * sd);
  };
  ProfileInterval interval;
  if (const auto below = distance(-1.0)) interval.lower = at - *below;
  if (const auto above = distance(1.0)) interval.upper = at + *above;
  return interval;
}

}  // namespace

std::vector<std::vector<ProfileInterval>> mean_intervals(const Likelihood& likelihood, const Fit& fit) {
  constexpr double kManySamples = 16000.0;  // shorter records are used as they are
  constexpr double kEnough = 8000.0;        // block means: level and drift depend on low frequencies
  const std::vector<MeanEstimate> means = likelihood.value(fit.u).means;
  // A record shorter than a block would be lost with block means.
  const std::optional<Likelihood> blocks =
      likelihood.samples() > kManySamples ? on_block_means(likelihood, kEnough) : std::nullopt;
  const Likelihood& followed = blocks && blocks->records().size() == likelihood.records().size() ? *blocks : likelihood;
  Fit top;
  top.u = fit.u;
  polish([&](const std::vector<double>& u) { return followed.slope(u); }, followed.model(),
         followed.model().ranges(followed.scale()), {}, {.tolerance = 1e-6}, top);
  std::vector<std::vector<ProfileInterval>> intervals(means.size());
  for (std::size_t r = 0; r < means.size(); ++r)
    for (Eigen::Index k = 0; k < means[r].value.size(); ++k)
      intervals[r].push_back(interval_of(followed, top, {r, k}, means[r].value(k)));
  return intervals;
}

}  // namespace coast::noise
