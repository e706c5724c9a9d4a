#include "coast/noise/sum_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kalman/fixed_model.hpp"

namespace coast::noise {

namespace {

std::span<const double> own(const std::vector<double>& u, const SumModel::Term& term) {
  return std::span(u).subspan(term.parameter, term.parameters);
}

/// Block-diagonal combination of blocks.
SampleBlock stacked(const std::vector<SampleBlock>& blocks) {
  Eigen::Index states = 0;
  for (const SampleBlock& block : blocks) states += block.h.size();
  SampleBlock sum = SampleBlock::zero(states);
  Eigen::Index at = 0;
  for (const SampleBlock& block : blocks) {
    const Eigen::Index n = block.h.size();
    sum.Phi.block(at, at, n, n) = block.Phi;
    sum.Q.block(at, at, n, n) = block.Q;
    sum.P_first.block(at, at, n, n) = block.P_first;
    sum.h.segment(at, n) = block.h;
    sum.white += block.white;
    at += n;
  }
  return sum;
}

}  // namespace

SampleBlock SampleBlock::zero(Eigen::Index states) {
  return {Eigen::MatrixXd::Zero(states, states), Eigen::MatrixXd::Zero(states, states), Eigen::MatrixXd::Zero(states, states),
          Eigen::RowVectorXd::Zero(states)};
}

SumModel::SumModel(const std::vector<const Estimable*>& processes, Mean mean) : mean_(mean) {
  for (const Estimable* process : processes) {
    const std::size_t count = process->parameters().size();
    terms_.push_back({process, parameters_, count, states_, process->states()});
    parameters_ += count;
    states_ += process->states();
  }
}

ParameterInfo SumModel::parameter(std::size_t i) const {
  for (const Term& term : terms_)
    if (i < term.parameter + term.parameters) return term.process->parameters()[i - term.parameter];
  throw std::invalid_argument(fmt::format("SumModel::parameter: {} of {}", i, parameters_));
}

std::string SumModel::parameter_name(std::size_t i) const {
  for (const Term& term : terms_) {
    if (i >= term.parameter + term.parameters) continue;
    const auto same = [&](const Term& other) { return other.process == term.process; };
    std::string name = fmt::format("{} {}", term.process->name(), term.process->parameters()[i - term.parameter].name);
    if (std::ranges::count_if(terms_, same) == 1) return name;
    return fmt::format("{} {}", name, 1 + std::ranges::count_if(std::span(terms_.data(), &term), same));
  }
  throw std::invalid_argument(fmt::format("SumModel::parameter_name: {} of {}", i, parameters_));
}

std::string SumModel::name() const {
  std::vector<std::pair<std::string_view, int>> counts;
  for (const Term& term : terms_) {
    const auto found = std::ranges::find(counts, term.process->symbol(), &std::pair<std::string_view, int>::first);
    if (found == counts.end())
      counts.emplace_back(term.process->symbol(), 1);
    else
      ++found->second;
  }
  std::string text;
  for (const auto& [symbol, count] : counts)
    text += fmt::format("{}{}{}", text.empty() ? "" : " + ", count > 1 ? fmt::format("{} ", count) : "", symbol);
  if (mean_ != Mean::kZero) text += " + level";
  if (mean_ == Mean::kLevelAndDrift) text += " + DR";
  return text;
}

std::vector<Interval> SumModel::ranges(const SignalScale& scale) const {
  std::vector<Interval> all;
  for (const Term& term : terms_)
    for (const Interval& range : term.process->ranges(scale)) all.push_back(range);
  return all;
}

std::vector<double> SumModel::values(const std::vector<double>& u) const {
  std::vector<double> all(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) all[i] = parameter(i).value(u[i]);
  return all;
}

bool SumModel::has_averages() const {
  Eigen::Index states = 0;
  for (const Term& term : terms_) {
    if (!term.process->has_averages()) return false;
    const std::vector<double> any(term.parameters, 0.0);
    states += term.process->block(any, SampleStep(1.0, 2)).h.size();
  }
  return states <= kMostStates;
}

SampleBlock SumModel::block(const std::vector<double>& u, const SampleStep& step) const {
  std::vector<SampleBlock> blocks;
  for (const Term& term : terms_) blocks.push_back(term.process->block(own(u, term), step));
  return stacked(blocks);
}

std::vector<SampleBlock> SumModel::derivatives(const std::vector<double>& u, const SampleStep& step) const {
  std::vector<SampleBlock> nothing;
  for (const Term& term : terms_) nothing.push_back(SampleBlock::zero(term.process->block(own(u, term), step).h.size()));
  std::vector<SampleBlock> all;
  for (std::size_t t = 0; t < terms_.size(); ++t)
    for (const SampleBlock& slope : terms_[t].process->derivatives(own(u, terms_[t]), step)) {
      std::vector<SampleBlock> blocks = nothing;
      blocks[t] = slope;
      all.push_back(stacked(blocks));
    }
  return all;
}

std::vector<ProcessPtr> SumModel::processes(const std::vector<double>& u, const Sampling& sampling) const {
  std::vector<ProcessPtr> all;
  for (const Term& term : terms_) all.push_back(term.process->process(own(u, term), sampling));
  return all;
}

}  // namespace coast::noise
