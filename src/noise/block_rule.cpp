#include "block_rule.hpp"

#include <algorithm>
#include <cmath>

namespace coast::noise {

std::size_t slow_block(const SumModel& model, const std::vector<double>& u, double interval) {
  constexpr double kSlow = 0.1;
  constexpr double kLongest = 1e6;
  double length = kLongest;
  for (const SumModel::Term& term : model.terms())
    if (!term.process->survives_averaging()) return 1;
  for (std::size_t i = 0; i < u.size(); ++i)
    if (model.parameter(i).kind == ParameterInfo::Kind::kRate) length = std::min(length, kSlow / (std::exp(u[i]) * interval));
  return length < 2.0 ? 1 : static_cast<std::size_t>(length);
}

}  // namespace coast::noise
