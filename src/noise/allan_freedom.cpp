// Equivalent degrees of freedom of means of squared differences, and the intervals that follow from them.

#include <algorithm>
#include <array>
#include <cmath>

#include "coast/noise/allan.hpp"
#include "coast/noise/chi_square.hpp"

namespace coast::noise {

namespace {

constexpr double kLagsPerAverage = 256.0;  // beyond this the sum over lags is an integral
constexpr double kLongestLag = 6.0;        // averages; the autocorrelation squared of flicker noise falls with lag^-4

/// Generalised autocovariance of the integral of power-law noise (Greenhall & Riley 2003, table 1), lag in averages; a factor
/// is irrelevant. The integral of quantisation noise is white and treated separately.
double integral_covariance(NoiseType noise, int order, double lag) {
  const double t = std::abs(lag);
  switch (noise) {
    case NoiseType::kQuantisation:
    case NoiseType::kWhite:
      return -t;
    case NoiseType::kFlicker:
      return t > 0.0 ? t * t * std::log(t) : 0.0;
    case NoiseType::kRamp:
      // The Allan variance of f^-4 noise does not exist; its terms are approximated by a random walk's.
      if (order == 3) return -t * t * t * t * t;
      [[fallthrough]];
    case NoiseType::kRandomWalk:
      return t * t * t;
  }
  return 0.0;
}

/// Autocovariance of differences of the given order: central differences of twice the order.
double difference_covariance(NoiseType noise, int order, double lag) {
  static constexpr std::array<double, 3> second{6.0, -4.0, 1.0};
  static constexpr std::array<double, 4> third{20.0, -15.0, 6.0, -1.0};
  double sum = 0.0;
  for (int k = -order; k <= order; ++k) {
    const auto at = static_cast<std::size_t>(std::abs(k));
    sum += (order == 2 ? second[at] : third[at]) * integral_covariance(noise, order, lag + k);
  }
  return sum;
}

/// For quantisation noise only terms an integer number of averages apart are correlated: binomial coefficients.
double quantisation_sum(const DifferencePlan& plan, double terms) {
  static constexpr std::array<double, 2> second{-4.0 / 6.0, 1.0 / 6.0};
  static constexpr std::array<double, 3> third{-15.0 / 20.0, 6.0 / 20.0, -1.0 / 20.0};
  double sum = 1.0;
  for (int i = 1; i <= plan.order; ++i) {
    const auto at = static_cast<std::size_t>(i - 1);
    const double correlation = plan.order == 2 ? second[at] : third[at];
    const double lag = i * static_cast<double>(plan.factor) / static_cast<double>(plan.stride);
    if (lag < terms) sum += 2.0 * (1.0 - lag / terms) * correlation * correlation;
  }
  return sum;
}

}  // namespace

// Var of a mean of n squares with autocorrelation rho: 2 R(0)^2/n (1 + 2 sum (1 - j/n) rho_j^2), and edf = 2 mean^2/var.
double degrees_of_freedom(NoiseType noise, const DifferencePlan& plan) {
  const auto runs = static_cast<double>(plan.runs);
  double terms = static_cast<double>(plan.terms) / runs;
  if (noise == NoiseType::kQuantisation) return runs * terms / quantisation_sum(plan, terms);
  const double starts = static_cast<double>(plan.factor) / static_cast<double>(plan.stride);
  const double step = std::max(1.0, std::floor(std::min(starts, terms) / kLagsPerAverage));  // terms
  terms /= step;
  // White noise and random walks: differences without a point in common are independent.
  const double longest = noise == NoiseType::kFlicker ? kLongestLag : plan.order;
  const double at_zero = difference_covariance(noise, plan.order, 0.0);
  double sum = 1.0;
  for (double j = 1.0; j < terms && j * step < longest * starts; j += 1.0) {
    const double correlation = difference_covariance(noise, plan.order, j * step / starts) / at_zero;
    sum += 2.0 * (1.0 - j / terms) * correlation * correlation;
  }
  return runs * terms / sum;
}

Interval chi_square_interval(double deviation, double edf, double coverage) {
  const double tail = 0.5 * (1.0 - coverage);
  return {.lower = deviation * std::sqrt(edf / chi2_upper_quantile(edf, tail)),
          .upper = deviation * std::sqrt(edf / chi2_upper_quantile(edf, 1.0 - tail))};
}

}  // namespace coast::noise
