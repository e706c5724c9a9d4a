#include "allan_curve.hpp"

#include <algorithm>
#include <cmath>

#include "coast/noise/chi_square.hpp"

namespace coast::noise {

namespace {

constexpr double kOneSigma = 0.682689492137;  // of a normal distribution within one sigma
constexpr double kFewAverages = 16.0;

Deviation deviation(double sum, std::uint64_t terms, double weight) {
  Deviation result;
  result.value = std::sqrt(weight * sum / static_cast<double>(terms));
  result.terms = terms;
  return result;
}

void state_confidence(Deviation& deviation, NoiseType noise, const DifferencePlan& plan) {
  deviation.edf = degrees_of_freedom(noise, plan);
  if (plan.stride > 1) {
    DifferencePlan full = plan;
    full.stride = 1;
    full.terms *= plan.stride;
    deviation.edf_lost = std::max(0.0, 1.0 - deviation.edf / degrees_of_freedom(noise, full));
  }
  deviation.interval_68 = chi_square_interval(deviation.value, deviation.edf, kOneSigma);
  deviation.interval_95 = chi_square_interval(deviation.value, deviation.edf, 0.95);
}

NoiseType nearest_type(double slope) {
  const double steps = std::clamp(std::round(2.0 * (slope + 1.0)), 0.0, 4.0);
  return static_cast<NoiseType>(static_cast<int>(steps));
}

void identify(AllanCurve& curve) {
  NoiseType last = NoiseType::kWhite;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    AllanPoint& point = curve[i];
    const double starts = static_cast<double>(point.factor) / static_cast<double>(point.overlap);
    const double averages = static_cast<double>(point.hadamard.terms) * starts / static_cast<double>(point.factor);
    const auto slope = averages < kFewAverages ? std::nullopt : local_slope(curve, i);
    point.identified = slope.has_value();
    if (slope) last = nearest_type(*slope);
    point.noise = last;
  }
}

}  // namespace

AllanCurve make_curve(double interval, std::span<const AveragingFactor> factors, std::span<const DifferenceSums> sums,
                      bool full_overlap) {
  AllanCurve curve;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (sums[i].third_terms == 0) continue;
    AllanPoint point;
    point.factor = factors[i].samples();
    point.tau = static_cast<double>(point.factor) * interval;
    point.overlap = full_overlap ? point.factor : factors[i].k;
    const double per_sample = 1.0 / static_cast<double>(point.factor);
    point.allan = deviation(sums[i].second, sums[i].second_terms, per_sample * per_sample / 2.0);
    point.hadamard = deviation(sums[i].third, sums[i].third_terms, per_sample * per_sample / 6.0);
    curve.push_back(point);
  }
  identify(curve);
  std::size_t at = 0;
  for (AllanPoint& point : curve) {
    while (factors[at].samples() != point.factor) ++at;
    DifferencePlan plan{.order = 2, .factor = point.factor, .stride = point.factor / point.overlap};
    plan.terms = sums[at].second_terms;
    plan.runs = sums[at].second_runs;
    state_confidence(point.allan, point.noise, plan);
    plan.order = 3;
    plan.terms = sums[at].third_terms;
    plan.runs = sums[at].third_runs;
    state_confidence(point.hadamard, point.noise, plan);
  }
  return curve;
}

std::optional<double> local_slope(const AllanCurve& curve, std::size_t at) {
  const auto within = [&](const AllanPoint& point) {
    return point.factor <= 2 * curve[at].factor && 2 * point.factor >= curve[at].factor && point.allan.value > 0.0;
  };
  double n = 0.0;
  double sum_x = 0.0;
  double sum_y = 0.0;
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  for (const AllanPoint& point : curve) {
    if (!within(point)) continue;
    const double x = std::log(point.tau / curve[at].tau);
    const double y = std::log(point.allan.value / curve[at].allan.value);
    n += 1.0;
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  if (n < 2.0 || curve[at].allan.value == 0.0) return {};
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

}  // namespace coast::noise
