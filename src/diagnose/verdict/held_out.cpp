#include "verdict/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coast/parallel.hpp"

namespace coast::diagnose {

namespace {

constexpr double kBlock = 30.0;    // s: longer than the correlation of innovations
constexpr double kFarthest = 3.0;  // sd by which half of the mission may change an effect that begins at some time

/// Blocks of the mission: of the common time of fixes and samples.
class Blocks {
 public:
  explicit Blocks(const MissionInput& input) : start_(std::max(input.gnss.fixes.front().t, input.imu.samples.front().t)) {
    end_ = std::min(input.gnss.fixes.back().t, input.imu.samples.back().t);
    count_ = static_cast<std::size_t>(std::max(0.0, end_ - start_) / kBlock) + 1;
  }
  [[nodiscard]] std::size_t of(geo::GpsTime t) const {
    return static_cast<std::size_t>(std::clamp((t - start_) / kBlock, 0.0, static_cast<double>(count_ - 1)));
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] bool contains(geo::GpsTime t) const { return t >= start_ && t <= end_; }

 private:
  geo::GpsTime start_, end_;
  std::size_t count_ = 0;
};

/// Log-likelihood of every block up to a constant, by a forward run; correlations between components are neglected. If the
/// filter fails, nothing is predicted.
std::vector<double> log_likelihoods(const MissionInput& input, const Blocks& blocks) {
  const std::optional<estimate::FilterResult> run = forward(input);
  if (!run) return std::vector<double>(blocks.count(), kBroken);
  std::vector<double> sums(blocks.count(), 0.0);
  for (const estimate::InnovationRecord& r : run->innovations) {
    if (!r.used) continue;
    double log_det = 0.0;
    for (int i = 0; i < r.dof && i < 3; ++i) log_det += 2.0 * std::log(r.sd(i));
    sums[blocks.of(r.t)] -= 0.5 * (r.nis + log_det);
  }
  return sums;
}

}  // namespace

// An effect with a large gain in few blocks and a loss in most others explains an accident. A block without information is
// better in half of the cases; an effect that begins at some time has information only at its beginning.
bool Verification::Effect::holds() const {
  constexpr double kByChance = 2.33;  // sd: 1 %
  if (!(gain > 0.0)) return false;
  return begins || better > 0.5 - kByChance * 0.5 / std::sqrt(static_cast<double>(blocks));
}

const Verification::Effect* Verification::worst() const {
  if (std::ranges::all_of(effects, &Effect::holds)) return nullptr;
  const auto at = std::ranges::min_element(
      effects, [](const Effect& a, const Effect& b) { return std::pair(a.holds(), a.gain) < std::pair(b.holds(), b.gain); });
  return &*at;
}

namespace {

/// Sizes from the blocks that are not held out.
std::vector<SelectedEffect> sizes_without(std::size_t fold, const Blocks& blocks, const State& state) {
  const Movement step = movement(state.run->sizes_where([&](geo::GpsTime t) { return blocks.of(t) % 2 != fold; }));
  std::vector<SelectedEffect> values = state.explanation.effects;
  for (std::size_t i = 0; i < values.size(); ++i) {
    // For an effect that begins within the held-out blocks the others have hardly any information.
    const double by = step.by(static_cast<Eigen::Index>(i));
    const double most = values[i].from ? kFarthest * state.account.findings[i].sd : std::abs(by);
    values[i].value += std::clamp(by, -most, most);
  }
  return values;
}

/// Each effect on the blocks of a fold, with the others. @param all  log-likelihoods with all of them
void add_effects(const std::vector<SelectedEffect>& values, const std::vector<double>& all, std::size_t fold,
                 const Blocks& blocks, const State& state, const Context& context, std::vector<Verification::Effect>& effects) {
  coast::parallel_for_each(effects, [&](Verification::Effect& effect) {
    std::vector<SelectedEffect> others = values;
    const auto at = others.begin() + static_cast<std::ptrdiff_t>(effect.first);
    others.erase(at, at + static_cast<std::ptrdiff_t>(effect.count));
    const std::vector<double> less = log_likelihoods(context.runs.with_sizes(others, *state.run), blocks);
    effect.begins = values[effect.first].from.has_value();
    const double by_noise = state.run->gain_by_own_noise(effect.first, effect.count) / static_cast<double>(blocks.count());
    for (std::size_t b = fold; b < blocks.count(); b += 2) {
      const double gain = all[b] - less[b] - by_noise;
      effect.gain += gain;
      if (gain > 0.0) effect.better += 1.0 / static_cast<double>(blocks.count());
      ++effect.blocks;
    }
  });
}

HeldOut summary(const std::vector<double>& with, const std::vector<double>& without, double epochs) {
  HeldOut h;
  h.blocks = static_cast<int>(with.size());
  double squares = 0.0;
  double before = 0.0;
  for (std::size_t b = 0; b < with.size(); ++b) {
    const double gain = with[b] - without[b];
    h.gain += gain;
    squares += gain * gain;
    before += without[b];
    if (gain > 0.0) h.better += 1.0;
  }
  const auto count = static_cast<double>(with.size());
  h.gain_sd = count > 1.0 ? std::sqrt(std::max(0.0, squares - h.gain * h.gain / count) * count / (count - 1.0)) : 0.0;
  h.better /= count;
  h.before_per_epoch = before / epochs;
  h.after_per_epoch = (before + h.gain) / epochs;
  return h;
}

}  // namespace

Verification verify(const State& state, const Context& context) {
  const Blocks blocks(state.run->input());
  const std::vector<double> without = log_likelihoods(context.runs.with_sizes({}, *state.run), blocks);
  std::vector<double> with(blocks.count(), 0.0);
  const double by_noise =
      state.run->gain_by_own_noise(0, state.explanation.effects.size()) / static_cast<double>(blocks.count());
  Verification result;
  for_each_selection(state.account,
                     [&](std::size_t first, std::size_t count) { result.effects.push_back({.first = first, .count = count}); });
  for (std::size_t fold = 0; fold < 2; ++fold) {
    const std::vector<SelectedEffect> values = sizes_without(fold, blocks, state);
    const std::vector<double> all = log_likelihoods(context.runs.with_sizes(values, *state.run), blocks);
    for (std::size_t b = fold; b < blocks.count(); b += 2) with[b] = all[b] - by_noise;
    add_effects(values, all, fold, blocks, state, context, result.effects);
  }
  const auto epochs = static_cast<double>(
      std::ranges::count_if(state.run->input().gnss.fixes, [&](const record::GnssFix& fix) { return blocks.contains(fix.t); }));
  result.all = summary(with, without, epochs);
  return result;
}

}  // namespace coast::diagnose
