#pragma once
// The gain that a filter settles to, without the steps that lead there, and how the start differs. Private to the room.

#include <cstdint>
#include <optional>
#include <vector>

#include "coast/noise/estimable.hpp"
#include "coast/noise/static_signal.hpp"

namespace coast::noise {

/// The stationary solution of the Riccati recursion.
struct StationaryGain {
  Eigen::MatrixXd P;  ///< predicted
  double S = 0.0;     ///< variance of the innovation
  Eigen::VectorXd k;  ///< P h'/S
  Eigen::VectorXd g;  ///< Phi k
  Eigen::MatrixXd F;  ///< Phi (I - k h)
};
/// By doubling: each step doubles the time that has passed. None if twice that again would still change it.
[[nodiscard]] std::optional<StationaryGain> stationary_gain(const SampleBlock& block);

/// Its derivative with respect to one parameter.
[[nodiscard]] StationaryGain slope_of(const StationaryGain& gain, const SampleBlock& block, const SampleBlock& derivative);

/// W = sum (A^t)' C' C A^t over `steps` times t: the products of the innovations e = c - h a of the filter without a signal,
/// a' = F a + g c, on a ramp c' = c + d, d' = d. Those of every start, level and drift at once, for states (a, c, d).
struct StartSums {
  Eigen::MatrixXd W;
  std::vector<Eigen::MatrixXd> dW;  ///< one per parameter
};
/// @param slopes  of the gain, one per parameter
[[nodiscard]] StartSums start_sums(const StationaryGain& gain, const SampleBlock& block,
                                   const std::vector<StationaryGain>& slopes, std::uint64_t steps);

/// The filter starts with another covariance than the stationary one: as if a state b of covariance D, the difference of
/// the two, had been added at the first sample (Lainiotis 1971). With innovations e of the stationary filter and those of b
/// alone, -X b, the record's covariance in terms of e is S I + X D X': all that is needed are sums over the record.
struct StartCorrection {
  StartCorrection(const StationaryGain& gain, const SampleBlock& block, const Eigen::MatrixXd& W);

  Eigen::MatrixXd D;
  Eigen::MatrixXd M;             ///< X'X
  Eigen::MatrixXd B;             ///< (I + M D/S)^-1
  double log_determinant = 0.0;  ///< of I + M D/S
  bool positive = true;
};

/// Long enough to be worth it, and without holes, which the stationary gain does not know.
[[nodiscard]] bool may_be_stationary(const StaticSignal& signal);

}  // namespace coast::noise
