#pragma once
// How long blocks may be whose means still hold all that a sum of processes tells. Private to the room.

#include "coast/noise/sum_model.hpp"

namespace coast::noise {

/// beta times the block at most 0.1 keeps 99 % of the information on every Gauss-Markov process; processes that live between
/// neighbouring samples (quantisation, autoregression) allow no block at all.
[[nodiscard]] std::size_t slow_block(const SumModel& model, const std::vector<double>& u, double interval);

}  // namespace coast::noise
