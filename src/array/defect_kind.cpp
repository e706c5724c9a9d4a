#include "defect_kind.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace coast::array {

namespace {

struct KindSpan {
  std::size_t from, to;
};

/// For one channel: how much likelier than noise alone its residual is with each kind.
struct KindScores {
  double jump = 0.0, scale = 0.0, swap = 0.0;  ///< log-likelihood ratios, each with its own variance, at least the usual one
  double left = 0.0;                           ///< remaining variance with the best of them, over the usual one
  double without = 0.0;                        ///< the same without any of them
  double within_blocks = 0.0;                  ///< of samples about their blocks' means
  double samples = 0.0;
  double offset = 0.0, factor = 1.0, noise_factor = 1.0;

  [[nodiscard]] double most() const { return std::max({jump, scale, swap}); }
};

/// -2/n log-likelihood of a mean square over the usual variance; the variance is free above the usual one.
double badness(double ratio) {
  return ratio > 1.0 ? 1.0 + std::log(ratio) : ratio;
}

class KindTest {
 public:
  KindTest(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present, const ParityBlocks& blocks,
           const std::vector<Channels>& noise, std::size_t sensor)
      : signals_(signals), present_(present), blocks_(blocks), noise_(noise), sensor_(sensor) {}

  [[nodiscard]] KindScores of(int channel, KindSpan span) const;

 private:
  struct Data {
    std::vector<double> residual;               ///< relative to the others, without the bias before
    double bias = 0.0;                          ///< the bias before
    std::vector<std::array<double, 3>> others;  ///< of the channel's group
    std::vector<std::size_t> columns;
  };
  [[nodiscard]] bool others_at(int channel, std::size_t n, double& value) const;
  [[nodiscard]] double bias_before(int channel, std::size_t from) const;
  [[nodiscard]] Data data(int channel, KindSpan span) const;
  [[nodiscard]] double variance_within_blocks(const Data& data) const;

  const Signals& signals_;
  const std::vector<std::vector<std::uint8_t>>& present_;
  const ParityBlocks& blocks_;
  const std::vector<Channels>& noise_;
  std::size_t sensor_;
};

bool KindTest::others_at(int channel, std::size_t n, double& value) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < signals_.sensors.size(); ++k)
    if (k != sensor_ && ((present_[k][n] >> channel) & 1) != 0)
      values.push_back(signals_.sensors[k].values(channel, static_cast<Eigen::Index>(n)) - blocks_.bias[k](channel));
  value = median_of(values);
  return !values.empty();
}

/// Over the five seconds before, if there are any; else over the record.
double KindTest::bias_before(int channel, std::size_t from) const {
  const auto second = static_cast<std::size_t>(std::ceil(1.0 / signals_.dt));
  double sum = 0.0, other = 0.0;
  std::size_t count = 0;
  for (std::size_t n = from > 5 * second ? from - 5 * second : 0; n < from; ++n) {
    if (((present_[sensor_][n] >> channel) & 1) == 0 || !others_at(channel, n, other)) continue;
    sum += signals_.sensors[sensor_].values(channel, static_cast<Eigen::Index>(n)) - other;
    ++count;
  }
  return count >= second ? sum / static_cast<double>(count) : blocks_.bias[sensor_](channel);
}

KindTest::Data KindTest::data(int channel, KindSpan span) const {
  Data data;
  const double bias = data.bias = bias_before(channel, span.from);
  const int group = channel / 3 * 3;
  for (std::size_t n = span.from; n < span.to; ++n) {
    std::array<double, 3> others{};
    bool all = ((present_[sensor_][n] >> channel) & 1) != 0;
    for (int c = 0; c < 3 && all; ++c) all = others_at(group + c, n, others.at(static_cast<std::size_t>(c)));
    if (!all) continue;
    data.others.push_back(others);
    data.residual.push_back(signals_.sensors[sensor_].values(channel, static_cast<Eigen::Index>(n)) - bias -
                            others.at(static_cast<std::size_t>(channel - group)));
    data.columns.push_back(n);
  }
  return data;
}

double KindTest::variance_within_blocks(const Data& data) const {
  double squares = 0.0, dof = 0.0;
  for (std::size_t i = 0; i < data.columns.size();) {
    std::size_t end = i;
    double sum = 0.0, sum2 = 0.0;
    while (end < data.columns.size() && data.columns[end] / blocks_.length == data.columns[i] / blocks_.length) {
      sum += data.residual[end];
      sum2 += data.residual[end] * data.residual[end];
      ++end;
    }
    const auto count = static_cast<double>(end - i);
    squares += std::max(0.0, sum2 - sum * sum / count);
    dof += count - 1.0;
    i = end;
  }
  return dof > 0.0 ? squares / dof : 0.0;
}

KindScores KindTest::of(int channel, KindSpan span) const {
  const Data data = this->data(channel, span);
  KindScores scores;
  scores.samples = static_cast<double>(data.residual.size());
  if (data.residual.size() < 2) return scores;
  const auto own = static_cast<std::size_t>(channel % 3);
  double others = 0.0;
  for (std::size_t k = 0; k < noise_.size(); ++k)
    if (k != sensor_) others += noise_[k](channel) / std::pow(static_cast<double>(noise_.size()) - 1.0, 2);
  const double variance = noise_[sensor_](channel) + others;
  const double n = scores.samples;
  double e = 0.0, ee = 0.0, et = 0.0, tt = 0.0;
  std::array<std::array<double, 2>, 3> as_axis{};
  for (std::size_t i = 0; i < data.residual.size(); ++i) {
    const double t = data.others[i].at(own);
    const double r = data.residual[i];
    e += r;
    ee += r * r;
    et += r * t;
    tt += t * t;
    for (std::size_t axis = 0; axis < 3; ++axis) {  // a swapped axis has its own bias too
      const double there = data.others[i].at(axis) + blocks_.bias[sensor_](channel / 3 * 3 + static_cast<int>(axis));
      as_axis.at(axis)[0] += std::pow(r + t + data.bias - there, 2);
      as_axis.at(axis)[1] += std::pow(r + t + data.bias + there, 2);
    }
  }
  scores.offset = e / n;
  scores.factor = 1.0 + (tt > 0.0 ? et / tt : 0.0);
  const double left_by_jump = (ee - e * e / n) / n / variance;
  const double left_by_scale = (ee - (tt > 0.0 ? et * et / tt : 0.0)) / n / variance;
  double left_by_swap = as_axis.at(own)[1];  // a changed sign counts as a swapped axis
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axis != own) left_by_swap = std::min({left_by_swap, as_axis.at(axis)[0], as_axis.at(axis)[1]});
  left_by_swap /= n * variance;
  scores.without = ee / n / variance;
  scores.jump = n / 2.0 * (badness(scores.without) - badness(left_by_jump));
  scores.scale = n / 2.0 * (badness(scores.without) - badness(left_by_scale));
  scores.swap = n / 2.0 * (badness(scores.without) - badness(left_by_swap));
  scores.left = std::min({left_by_jump, left_by_scale, left_by_swap});
  const double within = variance_within_blocks(data);
  scores.within_blocks = within / variance;
  scores.noise_factor = std::sqrt(std::max(0.0, within - others) / noise_[sensor_](channel));
  return scores;
}

}  // namespace

void name_defect(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present, const ParityBlocks& blocks,
                 const std::vector<Channels>& noise, std::size_t recovery, Defect& defect) {
  constexpr double kNotExplained = 3.0;  // times the usual variance, and
  constexpr double kShareLeft = 0.3;     // of the original variance
  const auto longest = static_cast<std::size_t>(30.0 / signals.dt);
  // A jump ends where its new level is known: only the samples after it identify it.
  std::size_t to = defect.to - defect.from < recovery ? defect.to + recovery : defect.to;
  to = std::min({to, signals.samples(), defect.from + longest});
  const KindTest test(signals, present, blocks, noise, defect.sensor);
  KindScores sum, clearest;
  for (int c = 0; c < kChannels; ++c) {
    if (((defect.channels >> c) & 1) == 0) continue;
    const KindScores one = test.of(c, {defect.from, to});
    sum.jump += one.jump;
    sum.scale += one.scale;
    sum.swap += one.swap;
    sum.samples += one.samples;
    if (clearest.samples == 0.0 || one.most() > clearest.most()) clearest = one;
  }
  // Noise that is not white favours a constant by a few units; one percent of a variance is not significant.
  const bool by_chance = sum.most() < 10.0 + 0.005 * sum.samples;
  const bool left_over = clearest.left > kNotExplained && clearest.left > kShareLeft * clearest.without;
  defect.size.reset();
  if (by_chance || left_over) {
    const bool white = clearest.within_blocks > 0.5 * clearest.without;
    defect.kind = white ? DefectKind::kNoiseBurst : DefectKind::kUnknown;
    if (white) defect.size = clearest.noise_factor;
  } else if (sum.most() == sum.swap) {
    defect.kind = DefectKind::kSwappedAxis;
  } else if (sum.most() == sum.scale) {
    defect.kind = DefectKind::kScaleChange;
    defect.size = clearest.factor;
  } else {
    defect.kind = DefectKind::kBiasJump;
    defect.size = clearest.offset;
  }
}

}  // namespace coast::array
