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

/// The first-order forms of Stebler et al. (2011): per step phi = 1 - beta dt, driven with dt * w in Table I, with w itself in
/// the matrices of sections II.B and II.E, both with var w = 2 beta sigma^2. They agree for dt = 1 s only, and neither keeps
/// sigma the stationary value.
enum class FirstOrderForm { kTable1, kSection2e };

/// A stationary first-order Gauss-Markov process by its parameters.
struct GaussMarkovValues {
  double beta = 0.0;    ///< 1/s
  double sigma2 = 0.0;  ///< stationary variance, [signal]^2
};
/// The process that steps of a first-order form make.  @param dt s, below 1/beta
[[nodiscard]] GaussMarkovValues exact_equivalent(const GaussMarkovValues& stated, FirstOrderForm form, double dt);

}  // namespace coast::noise
