#include "short_likelihood.hpp"

#include <algorithm>
#include <cmath>

namespace coast::noise {

namespace {
constexpr double kLong = 40000.0;  // values; shorter records are used as they are
}  // namespace

std::optional<Likelihood> on_block_means(const Likelihood& likelihood, double most_values) {
  const auto block = static_cast<std::size_t>(std::ceil(likelihood.samples() / most_values));
  if (block < 2 || !likelihood.model().has_averages()) return {};
  constexpr double kShare = 0.75;  // few missing samples hardly change a block's mean, but may be in every block
  std::vector<StaticSignal> means;
  for (const Detrended& record : likelihood.records()) {
    StaticSignal blocks = block_means(record.signal, block, kShare);
    if (!blocks.values.empty()) means.push_back(std::move(blocks));
  }
  if (means.empty()) return {};
  return Likelihood(means, likelihood.model(), block);
}

ShortLikelihood::ShortLikelihood(const Likelihood& likelihood) {
  constexpr double kBlocks = 4000.0;
  constexpr double kBeginning = 8000.0;
  if (likelihood.samples() < kLong) {
    parts_.push_back(likelihood);
    return;
  }
  whole_ = false;
  if (const auto means = on_block_means(likelihood, kBlocks)) parts_.push_back(*means);
  std::vector<StaticSignal> beginnings;
  for (const Detrended& record : likelihood.records())
    beginnings.push_back(
        part_of(record.signal, 0, static_cast<std::uint64_t>(kBeginning / static_cast<double>(likelihood.records().size()))));
  parts_.emplace_back(beginnings, likelihood.model());
}

double ShortLikelihood::value(const std::vector<double>& u) const {
  double sum = 0.0;
  for (const Likelihood& part : parts_) sum += part.value(u).log_likelihood;
  return sum;
}

double ShortLikelihood::at_mean(const std::vector<double>& u) const {
  double sum = 0.0;
  for (const Likelihood& part : parts_) sum += part.value(u).at_mean;
  return sum;
}

LikelihoodSlope ShortLikelihood::slope(const std::vector<double>& u) const {
  const auto p = static_cast<Eigen::Index>(u.size());
  LikelihoodSlope sum{0.0, Eigen::VectorXd::Zero(p), Eigen::MatrixXd::Zero(p, p)};
  for (const Likelihood& part : parts_) {
    const LikelihoodSlope at = part.slope(u);
    sum.log_likelihood += at.log_likelihood;
    if (!std::isfinite(sum.log_likelihood)) return sum;
    sum.gradient += at.gradient;
    sum.information += at.information;
  }
  return sum;
}

}  // namespace coast::noise
