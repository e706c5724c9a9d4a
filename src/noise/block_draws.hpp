#pragma once
// Fast simulation of records from a block. Private to the room.

#include <array>
#include <vector>

#include "coast/noise/estimable.hpp"
#include "kalman/fixed_model.hpp"
#include "normal_draws.hpp"

namespace coast::noise {

/// y[k] = h x[k] + v[k], with one deviate per noise source and sample. Loops have a length known at compile time: for the few
/// states of a usual sum finding the elements of Phi that are not zero costs more than adding the zeros.
class BlockDraws {
 public:
  BlockDraws(const SampleBlock& block, std::uint64_t seed);
  double next();

 private:
  using State = std::array<double, kMostStates>;
  using Columns = std::array<State, kMostStates>;

  template <std::size_t N>
  double next_of();

  NormalDraws normal_;
  Columns Phi_{};
  Columns step_{};                    ///< a root of Q
  std::vector<std::size_t> sources_;  ///< columns of it that are not zero
  State h_{};
  State x_{};
  double sd_ = 0.0;
  std::size_t states_ = 0;
};

}  // namespace coast::noise
