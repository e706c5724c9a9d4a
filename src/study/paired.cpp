#include "coast/study/paired.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace coast::study {

double quantile(std::vector<double> values, double p) {
  std::ranges::sort(values);
  const double at = p * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const auto high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

namespace {

// Probability of |T| <= t, with theta = atan(t / sqrt(dof)):
//     dof odd   2/pi (theta + sin (cos + 2/3 cos^3 + .. + 2 4..(dof-3) / (3 5..(dof-2)) cos^(dof-2)))    A & S 26.7.3
//     dof even  sin (1 + 1/2 cos^2 + .. + 1 3..(dof-3) / (2 4..(dof-2)) cos^(dof-2))                     A & S 26.7.4
double student_t_inside(double t, int dof) {
  const double theta = std::atan2(t, std::sqrt(static_cast<double>(dof)));
  const double c = std::cos(theta);
  const bool odd = dof % 2 == 1;
  double term = odd ? c : 1.0;
  double sum = 0.0;
  for (int k = odd ? 3 : 2; k <= dof; k += 2) {
    sum += term;
    term *= c * c * static_cast<double>(k - 1) / static_cast<double>(k);
  }
  return odd ? 2.0 / std::numbers::pi * (theta + std::sin(theta) * sum) : std::sin(theta) * sum;
}

}  // namespace

double student_t_quantile(double p, int dof) {
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument(fmt::format("student_t_quantile: p is {}, expected 0 to 1", p));
  if (dof < 1) throw std::invalid_argument(fmt::format("student_t_quantile: dof is {}, expected at least 1", dof));
  if (p < 0.5) return -student_t_quantile(1.0 - p, dof);
  const double inside = 2.0 * p - 1.0;
  double low = 0.0;
  double high = 1.0;
  while (student_t_inside(high, dof) < inside && high < 1e300) high *= 2.0;
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (student_t_inside(middle, dof) < inside ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double sign_test(std::size_t first, std::size_t second) {
  const auto n = static_cast<double>(first + second);
  double tail = 0.0;  // binomial probabilities from none to the rarer outcome
  for (std::size_t k = 0; k <= std::min(first, second); ++k) {
    const auto x = static_cast<double>(k);
    tail += std::exp(std::lgamma(n + 1.0) - std::lgamma(x + 1.0) - std::lgamma(n - x + 1.0) - n * std::numbers::ln2);
  }
  return std::min(1.0, 2.0 * tail);
}

namespace {

/// Equivalent number of independent stretches for a mean: n^2 / sum_ij w_ij.
double independent_stretches(std::vector<double> times, double reach) {
  std::ranges::sort(times);
  const auto n = static_cast<double>(times.size());
  double weights = n;
  for (std::size_t i = 0; i < times.size(); ++i)
    for (std::size_t j = i + 1; j < times.size() && times[j] - times[i] < reach; ++j)
      weights += 2.0 * (1.0 - (times[j] - times[i]) / reach);
  return n * n / weights;
}

}  // namespace

PairedRatio paired_ratio(std::span<const double> first, std::span<const double> second, std::span<const double> times,
                         double reach) {
  if (first.size() != second.size() || first.size() != times.size())
    throw std::invalid_argument(
        fmt::format("paired_ratio: {} and {} errors at {} times are no pairs", first.size(), second.size(), times.size()));
  PairedRatio result;
  std::vector<double> logs;
  std::vector<double> when;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!(first[i] > 0.0 && second[i] > 0.0)) continue;
    logs.push_back(std::log(second[i] / first[i]));
    when.push_back(times[i]);
    if (second[i] < first[i]) ++result.second_smaller;
    if (first[i] < second[i]) ++result.first_smaller;
  }
  result.pairs = logs.size();
  result.sign_test = sign_test(result.first_smaller, result.second_smaller);
  if (logs.empty()) return result;
  const auto n = static_cast<double>(logs.size());
  double mean = 0.0;
  for (const double d : logs) mean += d / n;
  result.ratio = result.low = result.high = std::exp(mean);
  constexpr double kRounding = 1e-9;
  const double stretches = independent_stretches(when, reach);
  if (stretches < 1.0 + kRounding) return result;
  double squares = 0.0;
  for (const double d : logs) squares += (d - mean) * (d - mean);
  const double variance = squares / n / (stretches - 1.0);
  const int dof = std::max(1, static_cast<int>(stretches + kRounding) - 1);
  const double half = student_t_quantile(0.975, dof) * std::sqrt(variance);
  result.low = std::exp(mean - half);
  result.high = std::exp(mean + half);
  return result;
}

PairedRatio paired_ratio(std::span<const double> first, std::span<const double> second) {
  std::vector<double> apart(first.size());
  std::iota(apart.begin(), apart.end(), 0.0);
  return paired_ratio(first, second, apart, 0.5);
}

}  // namespace coast::study
