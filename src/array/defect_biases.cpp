#include "defect_biases.hpp"

#include <algorithm>

namespace coast::array {

namespace {

/// A run with its channels in order, in whole blocks.
struct RunInOrder {
  BiasRun run;
  std::uint8_t channels = 0;
  std::size_t first = 0, end = 0;
};

std::vector<RunInOrder> runs_in_order(const ParityBlocks& blocks, const std::vector<Defect>& defects, std::size_t samples,
                                      std::size_t sensor) {
  std::vector<std::size_t> bounds{0, samples};
  for (const Defect& defect : defects)
    if (defect.sensor == sensor) bounds.insert(bounds.end(), {defect.from, defect.to});
  std::sort(bounds.begin(), bounds.end());
  bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
  std::vector<RunInOrder> runs;
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    RunInOrder next{{sensor, bounds[i], bounds[i + 1], Channels::Zero()}, kAllUsable, 0, 0};
    for (const Defect& defect : defects)
      if (defect.sensor == sensor && defect.from <= bounds[i] && defect.to >= bounds[i + 1])
        next.channels = static_cast<std::uint8_t>(next.channels & ~defect.channels);
    if (next.channels == 0) continue;
    next.first = (bounds[i] + blocks.length - 1) / blocks.length;
    next.end = std::min(bounds[i + 1] / blocks.length, blocks.count);
    runs.push_back(next);
  }
  return runs;
}

template <class Use>  // use(block) if the run has the channel in order
void for_each_block(const ParityBlocks& blocks, const RunInOrder& run, int channel, const Use& use) {
  if (((run.channels >> channel) & 1) == 0) return;
  for (std::size_t b = run.first; b < run.end; ++b)
    if (blocks.has(run.run.sensor, channel, b)) use(static_cast<Eigen::Index>(b));
}

/// Each iteration leaves at most half of the error with two sensors, a quarter with four.
void solve_channel(const ParityBlocks& blocks, std::vector<RunInOrder>& runs, int channel) {
  constexpr int kRounds = 12;
  Eigen::VectorXd common = blocks.common.row(channel);
  for (int round = 0; round < kRounds; ++round) {
    for (RunInOrder& run : runs) {
      double total = 0.0, members = 0.0;
      for_each_block(blocks, run, channel, [&](Eigen::Index b) {
        total += blocks.means[run.run.sensor](channel, b) - common(b);
        members += 1.0;
      });
      run.run.bias(channel) = members > 0.0 ? total / members : 0.0;
    }
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(common.size()), count = sum;
    for (const RunInOrder& run : runs) {
      for_each_block(blocks, run, channel, [&](Eigen::Index b) {
        sum(b) += blocks.means[run.run.sensor](channel, b) - run.run.bias(channel);
        count(b) += 1.0;
      });
    }
    for (Eigen::Index b = 0; b < common.size(); ++b)
      if (count(b) > 0.0) common(b) = sum(b) / count(b);
  }
}

}  // namespace

std::vector<BiasRun> piecewise_biases(const ParityBlocks& blocks, const std::vector<Defect>& defects, std::size_t samples) {
  std::vector<RunInOrder> runs;
  for (std::size_t k = 0; k < blocks.means.size(); ++k) {
    const std::vector<RunInOrder> own = runs_in_order(blocks, defects, samples, k);
    runs.insert(runs.end(), own.begin(), own.end());
  }
  for (int c = 0; c < kChannels; ++c) solve_channel(blocks, runs, c);
  std::vector<BiasRun> result;
  for (const RunInOrder& run : runs) result.push_back(run.run);
  return result;
}

}  // namespace coast::array
