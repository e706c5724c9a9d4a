#include "coast/noise/static_signal.hpp"

#include <algorithm>
#include <cmath>

namespace coast::noise {

namespace {

/// Appends samples one by one and keeps the runs.
class SignalBuilder {
 public:
  explicit SignalBuilder(const StaticSignal& like, double interval, std::size_t expected) {
    signal_.source = like.source;
    signal_.interval = interval;
    signal_.values.reserve(expected);
  }
  void add(std::uint64_t at, double value) {
    if (signal_.runs.empty() || at != signal_.length()) signal_.runs.push_back({at, signal_.values.size(), 0});
    signal_.values.push_back(value);
    ++signal_.runs.back().count;
  }
  [[nodiscard]] StaticSignal take() && { return std::move(signal_); }

 private:
  StaticSignal signal_;
};

}  // namespace

StaticSignal StaticSignal::regular(std::vector<double> values, double interval, const std::string& source) {
  StaticSignal signal{source, interval, std::move(values), {}};
  if (!signal.values.empty()) signal.runs.push_back({0, 0, signal.values.size()});
  return signal;
}

Detrended detrend(const StaticSignal& signal) {
  const auto n = static_cast<double>(signal.values.size());
  const double middle = 0.5 * static_cast<double>(signal.length() - 1);
  const auto sum_over = [&](const auto& term) {
    double sum = 0.0;
    for (const StaticSignal::Run& run : signal.runs) {
      double part = 0.0;  // partial sums lose fewer digits
      for (std::size_t i = 0; i < run.count; ++i)
        part += term(static_cast<double>(run.start + i) - middle, signal.values[run.first + i]);
      sum += part;
    }
    return sum;
  };
  Detrended result{signal};
  if (signal.values.empty()) return result;
  const double mean_t = sum_over([](double t, double) { return t; }) / n;
  const double mean_y = sum_over([](double, double y) { return y; }) / n;
  const double tt = sum_over([&](double t, double) { return (t - mean_t) * (t - mean_t); });
  const double slope = tt > 0.0 ? sum_over([&](double t, double y) { return (t - mean_t) * (y - mean_y); }) / tt : 0.0;
  result.level = mean_y - slope * mean_t;
  result.slope = slope / signal.interval;
  for (const StaticSignal::Run& run : signal.runs)
    for (std::size_t i = 0; i < run.count; ++i)
      result.signal.values[run.first + i] -= result.level + slope * (static_cast<double>(run.start + i) - middle);
  for (const double y : result.signal.values) result.variance += y * y / n;
  return result;
}

StaticSignal block_means(const StaticSignal& signal, std::size_t factor, double share) {
  if (factor <= 1) return signal;
  const auto least = static_cast<std::size_t>(std::ceil(share * static_cast<double>(factor)));
  SignalBuilder blocks(signal, signal.interval * static_cast<double>(factor), signal.values.size() / factor);
  std::uint64_t block = 0;
  double sum = 0.0;
  std::size_t count = 0;
  const auto finish = [&] {
    const bool within = (block + 1) * factor <= signal.length();
    if (within && count > 0 && count >= least) blocks.add(block, sum / static_cast<double>(count));
    sum = 0.0;
    count = 0;
  };
  for (const StaticSignal::Run& run : signal.runs)
    for (std::size_t i = 0; i < run.count; ++i) {
      const std::uint64_t here = (run.start + i) / factor;
      if (here != block) finish();
      block = here;
      sum += signal.values[run.first + i];
      ++count;
    }
  finish();
  return std::move(blocks).take();
}

StaticSignal part_of(const StaticSignal& signal, std::uint64_t from, std::uint64_t length) {
  SignalBuilder part(signal, signal.interval, static_cast<std::size_t>(length));
  for (const StaticSignal::Run& run : signal.runs) {
    const std::uint64_t begin = std::max(run.start, from);
    const std::uint64_t end = std::min(run.start + run.count, from + length);
    for (std::uint64_t at = begin; at < end; ++at)
      part.add(at - from, signal.values[run.first + static_cast<std::size_t>(at - run.start)]);
  }
  return std::move(part).take();
}

StaticSignal without(const StaticSignal& signal, std::span<const std::size_t> left_out) {
  SignalBuilder rest(signal, signal.interval, signal.values.size());
  auto next = left_out.begin();
  for (const StaticSignal::Run& run : signal.runs)
    for (std::size_t i = 0; i < run.count; ++i) {
      if (next != left_out.end() && *next == run.first + i) {
        ++next;
        continue;
      }
      rest.add(run.start + i, signal.values[run.first + i]);
    }
  return std::move(rest).take();
}

}  // namespace coast::noise
