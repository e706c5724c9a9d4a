#include "verdict/twins.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <utility>

#include "coast/diagnose/twin.hpp"
#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "coast/simulate/random.hpp"
#include "evidence/statistics.hpp"
#include "search/begin.hpp"

namespace coast::diagnose {

namespace {

double quantile(std::vector<double> sorted, double p) {
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

struct Spread {
  double mean = 0.0;
  double sd = 0.0;
  [[nodiscard]] double away(double value) const { return sd > 0.0 ? std::abs(value - mean) / sd : 0.0; }
};
/// @param without  a twin that is left out; larger than their number: none
Spread spread_of(const std::vector<std::vector<Statistic>>& twins, std::size_t figure, std::size_t without) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < twins.size(); ++i) {
    if (i == without) continue;
    sum += twins[i][figure].value;
    squares += twins[i][figure].value * twins[i][figure].value;
    count += 1.0;
  }
  if (count < 2.0) return {};  // one value gives no spread
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, (squares - count * mean * mean) / (count - 1.0)))};
}

/// The recording compared with its twins.
std::vector<TwinStatistic> against(const std::vector<Statistic>& real, const std::vector<std::vector<Statistic>>& twins) {
  std::vector<TwinStatistic> result;
  if (twins.empty()) return result;
  std::vector<double> farthest(twins.size(), 0.0);
  for (std::size_t j = 0; j < real.size(); ++j)
    for (std::size_t i = 0; i < twins.size(); ++i)
      farthest[i] = std::max(farthest[i], spread_of(twins, j, i).away(twins[i][j].value));
  for (std::size_t j = 0; j < real.size(); ++j) {
    std::vector<double> values;
    for (const std::vector<Statistic>& one : twins) values.push_back(one[j].value);
    std::ranges::sort(values);
    const double away = spread_of(twins, j, twins.size()).away(real[j].value);
    const auto as_far = static_cast<double>(std::ranges::count_if(farthest, [&](double f) { return f >= away; }));
    result.push_back({real[j].name, real[j].stretch, real[j].value, quantile(values, 0.05), quantile(values, 0.5),
                      quantile(values, 0.95), (1.0 + as_far) / (1.0 + static_cast<double>(twins.size()))});
  }
  return result;
}

/// The figures of an input from the first runs of a search.
std::vector<Statistic> figures_of(const MissionInput& input, std::uint64_t seed) {
  const study::Progress in_silence;
  Runs runs(with_open_gate(input), grade_of(input.setup.model), in_silence);
  Context context{{.seed = seed}, input.setup.noise_fit, runs};
  const State state = with_mended_samples(begin(context), context);
  return statistics_of(state.run->mission(), state.run->examined({.seed = seed}));
}

/// The figures of many recordings, on all threads; those for which the filter fails are left out.
std::vector<std::vector<Statistic>> all_figures(std::size_t count, const std::function<MissionInput(std::size_t)>& recording,
                                                std::uint64_t seed, const std::function<void(double)>& progress) {
  std::vector<std::vector<Statistic>> figures(count);
  std::mutex telling;  // one at a time
  std::size_t done = 0;
  coast::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    try {
      figures[i] = figures_of(recording(i), seed);
    } catch (const NumericalError&) {
      figures[i].clear();
    }
    const std::lock_guard lock(telling);
    ++done;
    progress(static_cast<double>(done) / static_cast<double>(count));
  });
  std::erase_if(figures, [](const std::vector<Statistic>& one) { return one.empty(); });
  return figures;
}

}  // namespace

MissionInput modelled(const State& state) {
  MissionInput input = state.run->input();
  for (const TurnOn& one : state.start.beyond) widen(one, input);
  return input;
}

std::vector<TwinStatistic> compared(const char* stage, const State& state, const Context& context,
                                    const std::vector<MissionInput>& simulations) {
  const MissionInput model = modelled(state);
  const study::Setup& configured = context.runs.recorded().setup;
  const std::uint64_t seed = context.options.seed;
  const auto recording = [&](std::size_t i) {
    if (!simulations.empty()) return simulations[i];
    MissionInput one = twin(state.run->mission().path(), model, simulate::stream_seed(seed, {3, i}));
    one.setup.start = configured.start;  // found in the same way as that of the recording
    one.setup.start_sensor_errors = configured.start_sensor_errors;
    return one;
  };
  const study::Progress& progress = context.runs.progress();
  const auto tell = [&](double done) {
    if (progress) progress(stage, done);
  };
  tell(0.0);
  const auto twins = static_cast<std::size_t>(std::max(0, context.options.twins));
  return against(statistics_of(state.run->mission(), state.run->examined({.seed = seed})),
                 all_figures(simulations.empty() ? twins : simulations.size(), recording, seed, tell));
}

}  // namespace coast::diagnose
