#include <cmath>
#include <type_traits>

#include "gain.hpp"
#include "gain_increments.hpp"
#include "passes.hpp"
#include "stationary_pass.hpp"

namespace coast::noise {

namespace {

/// @tparam Filter  Gain, or GainIncrements if there is no hole
template <int N, class Filter>
class InnovationPass {
 public:
  explicit InnovationPass(const FixedModel<N>& model, Filter& gain) : model_(model), gain_(gain) {}

  InnovationSums run(const StaticSignal& signal) {
    const GridTime time(signal);
    std::uint64_t at = 0;
    for (const StaticSignal::Run& run : signal.runs) {
      for (; at < run.start && sums_.positive; ++at) skip();
      std::size_t i = 0;
      for (; i < run.count && !gain_.steady() && sums_.positive; ++i)
        step({signal.values[run.first + i], 1.0, time.at(at + i)});
      if (sums_.positive) rest_of_run({signal.values.data() + run.first + i, run.count - i}, time.at(at + i), time.step());
      at += run.count;
    }
    return sums_;
  }

 private:
  using Columns = Eigen::Matrix<double, N, 3>;

  void skip() {
    if constexpr (std::is_same_v<Filter, Gain<N>>) {
      states_ = model_.sparse.left(states_);
      gain_.skip();
    }
  }
  void step(const Eigen::RowVector3d& z) {
    sums_.positive = gain_.S > 0.0 && std::isfinite(gain_.S);
    const Eigen::RowVector3d e = z - model_.h * states_;
    sums_.products.noalias() += e.transpose() * e / gain_.S;
    sums_.log_determinant += std::log(gain_.S);
    states_ = model_.sparse.left(Columns(states_ + gain_.k * e));
    gain_.step();
  }
  /// The gain is constant: a <- A a + b z with A = Phi (I - k h), b = Phi k.
  void rest_of_run(std::span<const double> values, double tau, double tau_step) {
    const typename FixedModel<N>::Matrix A = model_.Phi * (FixedModel<N>::Matrix::Identity() - gain_.k * model_.h);
    const typename FixedModel<N>::Vector b = model_.Phi * gain_.k;
    const typename FixedModel<N>::Row h = model_.h;
    Columns a = states_;
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Eigen::RowVector3d z(values[i], 1.0, tau + static_cast<double>(i) * tau_step);
      const Eigen::RowVector3d e = z - h * a;
      products.noalias() += e.transpose() * e;
      a = (A * a + b * z).eval();
    }
    states_ = a;
    sums_.products += products / gain_.S;
    sums_.log_determinant += static_cast<double>(values.size()) * std::log(gain_.S);
  }

  const FixedModel<N>& model_;
  Filter& gain_;
  Columns states_ = Columns::Zero();
  InnovationSums sums_;
};

/// Increments do not keep P, which a hole needs; without holes they make a sum of slow processes fast.
template <int N>
InnovationSums innovations_of(const SampleBlock& block, const StaticSignal& signal) {
  const FixedModel<N> model(block);
  if (signal.values.size() == signal.length() && GainIncrements<N>::apply_to(model)) {
    const std::vector<FixedModel<N>> no_slopes;
    GainIncrements<N> gain(model, no_slopes);
    return InnovationPass<N, GainIncrements<N>>(model, gain).run(signal);
  }
  Gain<N> gain(model);
  return InnovationPass<N, Gain<N>>(model, gain).run(signal);
}

template <int N>
std::vector<double> whiten(const SampleBlock& block, const StaticSignal& signal, const MeanCurve& mean, double gate) {
  constexpr int kPatience = 20;  // rejected in a row: then the filter is wrong
  int refused = 0;
  const FixedModel<N> model(block);
  Gain<N> gain(model);
  typename FixedModel<N>::Vector a = FixedModel<N>::Vector::Zero();
  const GridTime time(signal);
  std::vector<double> white;
  white.reserve(signal.values.size());
  std::uint64_t at = 0;
  for (const StaticSignal::Run& run : signal.runs) {
    for (; at < run.start; ++at) {
      a = (model.Phi * a).eval();
      gain.skip();
    }
    for (std::size_t i = 0; i < run.count; ++i, ++at) {
      const double e = signal.values[run.first + i] - mean.level - mean.drift * time.at(at) - model.h.dot(a);
      white.push_back(e / std::sqrt(gain.S));
      refused = std::abs(white.back()) > gate ? refused + 1 : 0;
      if (refused > 0 && refused < kPatience) {
        a = (model.Phi * a).eval();
        gain.skip();
        continue;
      }
      a = (model.Phi * (a + gain.k * e)).eval();
      gain.step();
    }
  }
  return white;
}

}  // namespace

InnovationSums innovation_pass(const SampleBlock& block, const StaticSignal& signal) {
  if (const std::optional<InnovationSums> sums = stationary_innovations(block, signal)) return *sums;
  return with_size(block.h.size(), [&](auto size) { return innovations_of<size()>(block, signal); });
}

std::vector<double> whitening_pass(const SampleBlock& block, const StaticSignal& signal, const MeanCurve& mean, double gate) {
  return with_size(block.h.size(), [&](auto size) { return whiten<size()>(block, signal, mean, gate); });
}

}  // namespace coast::noise
