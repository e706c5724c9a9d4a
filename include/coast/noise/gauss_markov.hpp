#pragma once

#include <string_view>

#include "coast/noise/process.hpp"

namespace coast::noise {

/// A stationary first-order Gauss-Markov process with any input; with beta = 0 a random constant. Scale factors, misalignments
/// and the filter's auxiliary states (lever arm, time offset, correlated GNSS error) are this under another name.
struct GaussMarkovParameters {
  std::string_view name;
  Input input = Input::kOne;
  double sigma = 0.0;     ///< stationary standard deviation, SI
  double beta = 0.0;      ///< 1/s; 0: a constant
  std::string_view unit;  ///< the unit in which yaml() writes sigma, a name of geo::units()
};
[[nodiscard]] ProcessPtr make_gauss_markov(const GaussMarkovParameters& parameters);

}  // namespace coast::noise
