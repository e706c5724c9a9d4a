#include "parity_thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coast/noise/chi_square.hpp"
#include "parity_blocks.hpp"

namespace coast::array {

namespace {

/// Probability of one evaluation, by the fixed point of u and its clumps.
double chance_per_evaluation(double per_hour, double step_s, std::size_t window, bool two_sided) {
  const double rate = per_hour * step_s / 3600.0;
  double chance = std::min(rate, 0.1);
  for (int round = 0; round < 20; ++round) {
    const double squared = noise::chi2_upper_quantile(1.0, two_sided ? chance : 2.0 * chance);
    chance = std::min(0.1, rate / std::min(1.0, squared / static_cast<double>(window)));
  }
  return chance;
}

}  // namespace

double normal_threshold(double per_hour, double step_s, std::size_t window, bool two_sided) {
  const double chance = chance_per_evaluation(per_hour, step_s, window, two_sided);
  return std::sqrt(noise::chi2_upper_quantile(1.0, two_sided ? chance : 2.0 * chance));
}

double chi2_threshold(double nu, double per_hour, double step_s, std::size_t window) {
  return noise::chi2_upper_quantile(nu, chance_per_evaluation(per_hour, step_s, window, false));
}

double for_uncertain_scale(double q, double epsilon) {
  return q * (1.0 + q * epsilon * epsilon);
}

double Inflation::at(double spread) const {
  return std::max(1.0, constant + slope * spread);
}

namespace {

/// A group's medians.
struct GroupOfRatios {
  double spread;
  double ratio;
};

std::vector<GroupOfRatios> medians_by_spread(std::vector<RatioAtSpread> ratios) {
  constexpr std::size_t kLeast = 10;
  std::sort(ratios.begin(), ratios.end(),
            [](const RatioAtSpread& a, const RatioAtSpread& b) { return a.spread.now < b.spread.now; });
  std::vector<GroupOfRatios> medians;
  for (std::size_t from = 0; from < ratios.size();) {
    const std::size_t left = ratios.size() - from;
    const std::size_t end = left < 2 * kLeast ? ratios.size() : from + left / 2;
    std::vector<double> spread, ratio;
    for (std::size_t i = from; i < end; ++i) {
      spread.push_back(ratios[i].spread.now);
      ratio.push_back(ratios[i].ratio);
    }
    const double middle = median_of(ratio);
    if (middle > 0.0) medians.push_back({median_of(spread), middle});
    from = end;
  }
  return medians;
}

}  // namespace

Inflation fit_inflation(std::vector<RatioAtSpread> ratios) {
  constexpr std::size_t kLeast = 10;
  if (ratios.size() < kLeast) return {};
  // Sums of (constant + slope x)/m against 1.
  double a = 0.0, b = 0.0, aa = 0.0, ab = 0.0, bb = 0.0;
  for (const GroupOfRatios& group : medians_by_spread(std::move(ratios))) {
    const double one = 1.0 / group.ratio, x = group.spread / group.ratio;
    a += one;
    b += x;
    aa += one * one;
    ab += one * x;
    bb += x * x;
  }
  const double determinant = aa * bb - ab * ab;
  if (!(aa > 0.0)) return {};
  if (!(determinant > 1e-12 * aa * bb) || aa * b < ab * a) return {a / aa, 0.0};
  if (a * bb < ab * b) return {0.0, b / bb};
  return {(a * bb - ab * b) / determinant, (aa * b - ab * a) / determinant};
}

LargestRatios largest_ratios(const std::vector<RatioAtSpread>& ratios, const Inflation& inflation, std::size_t piece) {
  LargestRatios largest;
  for (std::size_t from = 0; from < ratios.size(); from += piece) {
    double together = -1.0, apart = -1.0;
    for (std::size_t i = from; i < std::min(from + piece, ratios.size()); ++i) {
      double& most = ratios[i].spread.apart() ? apart : together;
      most = std::max(most, ratios[i].ratio / inflation.at(ratios[i].spread.now));
    }
    if (together >= 0.0) largest.together.push_back(together);
    if (apart >= 0.0) largest.apart.push_back(apart);
  }
  return largest;
}

namespace {

constexpr std::size_t kFewestPieces = 12;
// Powers of the ratio whose tail is taken for exponential. A normal's squares have such a tail. In impacts and vibration the
// size itself varies from sensor to sensor, and what is known of it is the spread of a few: Student's tail.
constexpr double kNormal = 1.0;
constexpr double kStudent = 0.25;

/// The threshold asked for by the maxima of pieces, over that for normal noise. @param power  of the ratio whose tail is
/// exponential
double factor_of_maxima(std::vector<double> maxima, const TailFit& fit, double power) {
  if (maxima.size() < kFewestPieces) return 1.0;
  for (double& ratio : maxima) ratio = std::pow(ratio, power);
  std::sort(maxima.begin(), maxima.end());
  constexpr double kLow = 0.3, kHigh = 0.6;
  const auto value = [&](double share) { return maxima[static_cast<std::size_t>(share * static_cast<double>(maxima.size()))]; };
  const auto reduced = [](double share) { return -std::log(-std::log(share)); };  // x = place + width reduced
  const double width = (value(kHigh) - value(kLow)) / (reduced(kHigh) - reduced(kLow));
  return std::max(1.0, std::pow(value(kLow) + width * (-std::log(fit.chance) - reduced(kLow)), 1.0 / power) / fit.threshold);
}

/// Of the sensors' windows of one kind.
std::vector<double> factors_of(const std::vector<LargestRatios>& sensors, const std::vector<TailFit>& fits,
                               std::vector<double> LargestRatios::*kind, double power) {
  std::vector<double> all, factors;
  for (const LargestRatios& sensor : sensors) all.insert(all.end(), (sensor.*kind).begin(), (sensor.*kind).end());
  for (std::size_t k = 0; k < sensors.size(); ++k)
    factors.push_back(factor_of_maxima((sensors[k].*kind).size() < kFewestPieces ? all : sensors[k].*kind, fits[k], power));
  return factors;
}

}  // namespace

void fit_tails(const std::vector<LargestRatios>& sensors, const std::vector<TailFit>& fits, std::vector<Growth>& growth) {
  const std::vector<double> together = factors_of(sensors, fits, &LargestRatios::together, kNormal);
  const std::vector<double> apart = factors_of(sensors, fits, &LargestRatios::apart, kStudent);
  for (std::size_t k = 0; k < growth.size(); ++k) {
    growth[k].together = together[k];
    growth[k].apart = apart[k];
  }
}

Growth usual_growth(const std::vector<Growth>& sensors) {
  const auto median = [&](auto coefficient) {
    std::vector<double> values;
    for (const Growth& sensor : sensors) values.push_back(coefficient(sensor));
    return median_of(values);
  };
  return {
      {median([](const Growth& g) { return g.inflation.constant; }), median([](const Growth& g) { return g.inflation.slope; })},
      median([](const Growth& g) { return g.together; }),
      median([](const Growth& g) { return g.apart; })};
}

}  // namespace coast::array
