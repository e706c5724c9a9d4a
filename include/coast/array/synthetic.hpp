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
  kGarch,      ///< weights by each sensor's own variance, predicted by its GARCH model for the sample
  kCorrected,  ///< the same, and each sensor's error predicted by its ARMA model is subtracted: Eq. (12)
  kExtended,   ///< given weights, from each sensor's own error model (extended.hpp)
};

struct MergeOptions {
  Merge merge = Merge::kWeighted;
  noise::ArmaGarchOrders orders{3, 2, 1, 1};  ///< those of the paper
  bool choose_orders = false;                 ///< from `arma_garch_grid()` by AICc, summed over the sensors of a channel
  double window_s = 2.0;                      ///< window of the noise over time
  Eigen::MatrixXd weights = {};               ///< 6 x K, for kExtended
};

/// Tests whether a model's standardised residuals e / sigma are white, of constant variance, and normal.
struct ModelTests {
  noise::ResidualTest white;   ///< Ljung & Box, 20 lags
  noise::ResidualTest even;    ///< ARCH-LM, 10 lags
  noise::ResidualTest normal;  ///< Jarque & Bera
};

/// One channel of the synthetic IMU.
struct MergedChannel {
  Eigen::VectorXd value;      ///< N
  Eigen::VectorXd variance;   ///< N, of a sample's noise, as used in the weights
  Eigen::VectorXd weight;     ///< K, mean over time
  NoiseOverTime noise;        ///< of the sensors, measured
  Eigen::MatrixXd predicted;  ///< K x blocks of `noise`: mean own variance by the GARCH models; empty without them
  std::vector<noise::ArmaGarchFit> models;  ///< one per sensor if GARCH is used
  std::vector<ModelTests> tests;            ///< of the models
};

/// @param signals    with offsets subtracted
/// @param reference  N true values, if available: residuals are then the sensors' own errors, not Eq. (11)
/// @throws std::invalid_argument  fewer than two sensors, a reference of another length, too few samples for the orders
[[nodiscard]] MergedChannel merge_channel(const Signals& signals, int channel, const MergeOptions& options,
                                          const std::optional<Eigen::VectorXd>& reference = {});

/// Noise density of the merged signal over that of the plain mean, from the variances used in the weights and the measured
/// noise of the sensors; 1 without noise. The variance of a GARCH model is conditional on the past; it is scaled up to the
/// measured variance.
[[nodiscard]] double white_share(const MergedChannel& merged);

}  // namespace coast::array
