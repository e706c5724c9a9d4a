#pragma once
// The synthetic IMU: one signal from several, Stebler et al. (2011), Eqs. (6) and (12) to (15).

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "coast/array/channel.hpp"
#include "coast/noise/arma_garch.hpp"
#include "coast/noise/residual_tests.hpp"

namespace coast::array {

enum class Merge {
  kMean,       ///< Eq. (6): equal weights
  kWeighted,   ///< weights by each sensor's mean own variance, constant in time
  kGarch,      ///< weights by each sensor's own variance as its GARCH model predicts it for the sample
  kCorrected,  ///< the same, and what the ARMA model predicts of each sensor's error taken off: Eq. (12)
  kExtended,   ///< weights that are given, by each sensor's own error model (extended.hpp)
};

struct MergeOptions {
  Merge merge = Merge::kWeighted;
  noise::ArmaGarchOrders orders{3, 2, 1, 1};  ///< the paper's
  bool choose_orders = false;                 ///< by AICc, summed over the sensors of a channel, from `arma_garch_grid()`
  double window_s = 2.0;                      ///< of the noise over time
  Eigen::MatrixXd weights = {};               ///< 6 x K, of kExtended
};

/// Whether a model left its sensor's residuals white, of even variance, and normal: standardised e / sigma.
struct ModelTests {
  noise::ResidualTest white;   ///< Ljung & Box, 20 lags
  noise::ResidualTest even;    ///< ARCH-LM, 10 lags
  noise::ResidualTest normal;  ///< Jarque & Bera
};

/// One channel of the synthetic IMU.
struct MergedChannel {
  Eigen::VectorXd value;                    ///< N
  Eigen::VectorXd variance;                 ///< N, of a sample's noise, as the weights have it
  Eigen::VectorXd weight;                   ///< K, mean over time
  NoiseOverTime noise;                      ///< of the sensors, measured
  Eigen::MatrixXd predicted;                ///< K x blocks of `noise`: mean own variance by the GARCH models; empty without
  std::vector<noise::ArmaGarchFit> models;  ///< one per sensor where GARCH is used
  std::vector<ModelTests> tests;            ///< of the models
};

/// @param signals    offsets taken off
/// @param reference  N true values where there are some: residuals are then the sensors' own errors, not Eq. (11)
/// @throws std::invalid_argument  fewer than two sensors, a reference of another length, too few samples for the orders
[[nodiscard]] MergedChannel merge_channel(const Signals& signals, int channel, const MergeOptions& options,
                                          const std::optional<Eigen::VectorXd>& reference = {});

/// Density of what was merged over that of the plain mean, by the variances behind the weights and the measured noise of the
/// sensors; 1 without noise. A GARCH model's variance is that of a sample given the past: it is raised by what that leaves out
/// of the measured.
[[nodiscard]] double white_share(const MergedChannel& merged);

}  // namespace coast::array
