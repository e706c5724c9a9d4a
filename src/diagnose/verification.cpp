#include "verification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coast::diagnose {

namespace {

constexpr double kBlock = 30.0;       // s: longer than innovations are correlated
constexpr double kDeviations = 2.33;  // 1 %
constexpr double kFarthest = 3.0;     // sd by which half of the mission may move what begins at some time

/// Blocks of the mission: of the time that fixes and samples have in common.
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

/// Log-likelihood of every block but for a constant, by a forward run; correlations between components are left out. What
/// breaks the filter predicts nothing.
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

// What gains much in few blocks and loses in most of the others explains an accident. What says nothing in a block is better
// there as often as not; what begins at some time speaks at its beginning alone.
bool Verification::Effect::holds() const {
  if (!(gain > 0.0)) return false;
  return begins || better > 0.5 - kDeviations * 0.5 / std::sqrt(static_cast<double>(blocks));
}

Verification verify(const Search& search) {
  const Blocks blocks(search.input());
  std::vector<Taken> none;
  const std::vector<double> without = log_likelihoods(search.with_values(none), blocks);
  std::vector<double> with(blocks.count(), 0.0);
  Verification result;
  result.effects.resize(search.taken().size());
  for (std::size_t fold = 0; fold < 2; ++fold) {
    const Examination examination = search.examined([&](geo::GpsTime t) { return blocks.of(t) % 2 != fold; }, 0);
    std::vector<Taken> values = search.taken();
    const Movement moved = movement(examination, values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      // Of what begins within the blocks that are held out the others know next to nothing.
      const double by = moved.by(static_cast<Eigen::Index>(i));
      const double most = values[i].from ? kFarthest * search.sd(i) : std::abs(by);
      values[i].value += std::clamp(by, -most, most);
    }
    const std::vector<double> all = log_likelihoods(search.with_values(values), blocks);
    for (std::size_t b = fold; b < blocks.count(); b += 2) with[b] = all[b];
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::vector<Taken> others = values;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const std::vector<double> less = log_likelihoods(search.with_values(others), blocks);
      Verification::Effect& effect = result.effects[i];
      effect.begins = values[i].from.has_value();
      for (std::size_t b = fold; b < blocks.count(); b += 2) {
        effect.gain += all[b] - less[b];
        if (all[b] > less[b]) effect.better += 1.0 / static_cast<double>(blocks.count());
        ++effect.blocks;
      }
    }
  }
  HeldOut& h = result.all;
  h.blocks = static_cast<int>(blocks.count());
  double squares = 0.0;
  double before = 0.0;
  for (std::size_t b = 0; b < blocks.count(); ++b) {
    const double gain = with[b] - without[b];
    h.gain += gain;
    squares += gain * gain;
    before += without[b];
    if (gain > 0.0) h.better += 1.0;
  }
  const auto count = static_cast<double>(blocks.count());
  h.gain_sd = count > 1.0 ? std::sqrt(std::max(0.0, squares - h.gain * h.gain / count) * count / (count - 1.0)) : 0.0;
  h.better /= count;
  const auto epochs = static_cast<double>(
      std::ranges::count_if(search.input().gnss.fixes, [&](const record::GnssFix& fix) { return blocks.contains(fix.t); }));
  h.before_per_epoch = before / epochs;
  h.after_per_epoch = (before + h.gain) / epochs;
  return result;
}

PairedDifference outage_difference(const Fit& before, const Fit& after) {
  PairedDifference d;
  const std::size_t count = before.outages_m.size();
  if (count != after.outages_m.size() || count < 2) return d;
  d.count = static_cast<int>(count);
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double farther = after.outages_m[i] - before.outages_m[i];
    sum += farther;
    squares += farther * farther;
  }
  const double n = d.count;
  d.mean = sum / n;
  d.sd = std::sqrt(std::max(0.0, squares - n * d.mean * d.mean) / (n * (n - 1.0)));
  return d;
}

bool drifts_farther(const Fit& before, const Fit& after) {
  constexpr double kFarther = 1.5;
  const PairedDifference d = outage_difference(before, after);
  return after.outage_rms_m > kFarther * before.outage_rms_m && d.mean > kDeviations * d.sd;
}

std::optional<std::size_t> what_spoils_outages(const Search& search) {
  const std::vector<Taken>& taken = search.taken();
  if (taken.empty()) return std::nullopt;
  if (!drifts_farther(search.fit_with({}), search.run().fit())) return std::nullopt;
  std::size_t worst = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < taken.size(); ++i) {
    std::vector<Taken> others = taken;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const double rms = search.fit_with(others).outage_rms_m;
    if (rms < least) worst = i;
    least = std::min(least, rms);
  }
  return worst;
}

}  // namespace coast::diagnose
