#include "residuals.hpp"

#include <algorithm>
#include <numeric>

#include "coast/array/channel.hpp"

namespace coast::array {

double plain_mean(const Signals& signals, int channel, std::size_t n) {
  const auto column = static_cast<Eigen::Index>(n);
  double sum = 0.0;
  double all = 0.0;
  int count = 0;
  for (const SensorSignals& sensor : signals.sensors) {
    const double value = sensor.values(channel, column);
    all += value;
    if (!sensor.may_use(channel, n)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : all / static_cast<double>(signals.sensors.size());
}

void solve_own_variances(std::span<double> variances) {
  const auto K = static_cast<double>(variances.size());
  // Summed over k the equations give sum v = S (1 - 1/K).
  const double total = std::accumulate(variances.begin(), variances.end(), 0.0) * K / (K - 1.0);
  for (double& v : variances) {
    const double solved = variances.size() == 2 ? total / K : (v - total / (K * K)) / (1.0 - 2.0 / K);
    v = std::max(solved, kLeastShare * total / K);
  }
}

SpreadOfChange spread_of_change(const Signals& signals, int channel, std::size_t n) {
  const auto column = static_cast<Eigen::Index>(n);
  SpreadOfChange spread;
  double mean = 0.0;
  for (const SensorSignals& sensor : signals.sensors) {  // Welford (1962): one pass, no cancellation
    if (!sensor.may_use(channel, n) || !sensor.may_use(channel, n - 1)) continue;
    const double change = sensor.values(channel, column) - sensor.values(channel, column - 1);
    ++spread.sensors;
    const double from_mean = change - mean;
    mean += from_mean / spread.sensors;
    spread.variance += from_mean * (change - mean);
  }
  if (spread.sensors > 1) spread.variance /= spread.sensors - 1;
  return spread;
}

}  // namespace coast::array
