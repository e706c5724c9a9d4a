#include <algorithm>
#include <cmath>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/alignment.hpp"

namespace coast::ins {
namespace {

// Means over a quarter of a second: engine vibration (10 Hz and more) averages out, the start of a movement does not.
constexpr double kBlock = 0.25;  // s
constexpr std::size_t kBlocksPerSecond = 4;

// Bounds independent of the quietest part of the recording (which may be a flight).
constexpr double kMaxForceSpread = 0.3;                  // m/s^2, of block means within a second
constexpr double kMaxRateSpread = 1.0 * geo::kDegree;    // rad/s
constexpr double kMaxRate = 6.0 * geo::kDegree;          // rad/s, bias of a poor MEMS included
constexpr double kMaxForceError = 0.7;                   // m/s^2, of |f| relative to gravity: bias and scale of a poor MEMS
constexpr double kForceFloor = 0.02, kRateFloor = 5e-4;  // a perfectly quiet recording has no quantile as scale
constexpr double kQuietFactor = 12.0;

struct Block {
  std::size_t first = 0;
  std::size_t last = 0;  // inclusive
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  bool bridged = false;  ///< a gap of the recording: its content was not measured
};

// A sample that bridges a gap is a separate block of any length; so is every sample of an IMU slower than 2 Hz.
std::vector<Block> block_means(const std::vector<record::ImuSample>& samples, double rate_hz) {
  const double longest = 1.5 / rate_hz + 0.1;  // s
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < samples.size();) {
    Block block{i, i, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), samples[i].dt > longest};
    double length = 0.0;
    do {
      length += samples[i].dt;
      block.force += samples[i].dv;
      block.rate += samples[i].dtheta;
      block.last = i;
      ++i;
    } while (!block.bridged && i < samples.size() && samples[i].dt <= longest && length < kBlock - 0.5 * samples[i].dt);
    block.force /= length;
    block.rate /= length;
    blocks.push_back(block);
  }
  return blocks;
}

// Largest distance of block means from the mean of the second around block i.
struct Spread {
  double force = 0.0;
  double rate = 0.0;
};
Spread spread_around(const std::vector<Block>& blocks, std::size_t i) {
  const std::size_t first = i >= kBlocksPerSecond / 2 ? i - kBlocksPerSecond / 2 : 0;
  const std::size_t end = std::min(blocks.size(), first + kBlocksPerSecond);
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
  for (std::size_t j = first; j < end; ++j) {
    force += blocks[j].force / static_cast<double>(end - first);
    rate += blocks[j].rate / static_cast<double>(end - first);
  }
  Spread spread;
  for (std::size_t j = first; j < end; ++j) {
    spread.force = std::max(spread.force, (blocks[j].force - force).norm());
    spread.rate = std::max(spread.rate, (blocks[j].rate - rate).norm());
  }
  return spread;
}

double quantile(std::vector<double> values, double p) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// GNSS agrees with standstill between two fixes: no velocity, no displacement beyond the uncertainties.
bool gnss_stands(const record::GnssFix& fix, const record::GnssFix& next) {
  constexpr double kSigmas = 4.0;
  constexpr double kSlow = 0.1;  // m/s, for any sigma of the fixes
  const double sd = std::sqrt(std::max(fix.position_cov_n.trace(), next.position_cov_n.trace()));
  if ((next.r_ea_e - fix.r_ea_e).norm() > kSlow * (next.t - fix.t) + kSigmas * sd) return false;
  if (!fix.velocity) return true;
  return fix.velocity->v_ea_n.norm() < kSlow + kSigmas * std::sqrt(fix.velocity->cov_n.trace());
}

// Marks blocks in which GNSS moves. Over at least a second, so that noise of close fixes does not appear as speed.
void exclude_gnss_motion(const std::vector<record::ImuSample>& samples, const std::vector<Block>& blocks,
                         const record::GnssRecording& gnss, std::vector<bool>& still) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < gnss.fixes.size(); ++k) {
    while (next + 1 < gnss.fixes.size() && gnss.fixes[next].t - gnss.fixes[k].t < 1.0) ++next;
    if (next == k || gnss_stands(gnss.fixes[k], gnss.fixes[next])) continue;
    const auto after = [&](const Block& block, geo::GpsTime t) { return samples[block.last].t < t; };
    auto block = std::lower_bound(blocks.begin(), blocks.end(), gnss.fixes[k].t, after);
    for (; block != blocks.end() && samples[block->first].t < gnss.fixes[next].t; ++block)
      still[static_cast<std::size_t>(block - blocks.begin())] = false;
  }
}

// Time between two samples not covered by either of them.
bool missing_time(const std::vector<record::ImuSample>& samples, std::size_t i) {
  return (samples[i].t - samples[i - 1].t) > 1.5 * samples[i].dt + 0.1;
}

}  // namespace

std::vector<StaticPeriod> find_static_periods(const record::ImuRecording& body, const record::GnssRecording* gnss,
                                              double min_duration_s) {
  const std::vector<record::ImuSample>& samples = body.samples;
  std::vector<StaticPeriod> periods;
  if (samples.empty()) return periods;
  const std::vector<Block> blocks = block_means(samples, body.rate_hz);
  std::vector<double> force_spread, rate_spread;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Spread spread = spread_around(blocks, i);
    force_spread.push_back(spread.force);
    rate_spread.push_back(spread.rate);
  }
  const double force_bound = std::min(kMaxForceSpread, kQuietFactor * quantile(force_spread, 0.05) + kForceFloor);
  const double rate_bound = std::min(kMaxRateSpread, kQuietFactor * quantile(rate_spread, 0.05) + kRateFloor);
  const bool has_fixes = gnss != nullptr && !gnss->fixes.empty();
  const double gravity = has_fixes ? geo::gravity_e(gnss->fixes.front().r_ea_e).norm() : geo::kStandardGravity;

  std::vector<bool> still(blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i)
    still[i] = !blocks[i].bridged && force_spread[i] < force_bound && rate_spread[i] < rate_bound &&
               blocks[i].rate.norm() < kMaxRate && std::abs(blocks[i].force.norm() - gravity) < kMaxForceError;
  if (has_fixes) exclude_gnss_motion(samples, blocks, *gnss, still);

  // Runs of still blocks whose means stay close to those at its beginning: a slow rotation or tilt ends it.
  for (std::size_t i = 0; i < blocks.size();) {
    if (!still[i]) {
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    Eigen::Vector3d force = blocks[i].force, rate = blocks[i].rate;
    while (end < blocks.size() && still[end] && !missing_time(samples, blocks[end].first) &&
           (blocks[end].force - force).norm() < 2.0 * force_bound && (blocks[end].rate - rate).norm() < 2.0 * rate_bound) {
      const double weight = 1.0 / static_cast<double>(end - i + 1);
      force += weight * (blocks[end].force - force);
      rate += weight * (blocks[end].rate - rate);
      ++end;
    }
    const StaticPeriod period{blocks[i].first, blocks[end - 1].last};
    if (samples[period.last].t - samples[period.first].t + samples[period.first].dt >= min_duration_s)
      periods.push_back(period);
    i = end;
  }
  return periods;
}

}  // namespace coast::ins
