#pragma once
// Exact scores of the noise parameters from one recorded pass of the filter; private to the room.

#include "noise_parameters.hpp"
#include "pass_record.hpp"

namespace coast::estimate {

/// Derivative of the start with respect to the logarithm of a parameter.
struct StartSlope {
  Eigen::VectorXd estimate;  ///< in errors: navigation states as error_between() has them
  Eigen::MatrixXd P;
};

/// Inputs of a pass.
struct NoiseModel {
  const Mission& mission;
  const StateLayout& layout;
  NoiseAdjustment adjustment;
  const std::vector<NoiseParameter>& parameters;
  std::vector<StartSlope> start;  ///< one per parameter
};

struct NoiseScores {
  Eigen::VectorXd gradient;     ///< of the log-likelihood with respect to the logarithms of the parameters
  Eigen::MatrixXd information;  ///< mean of the observed and the expected one
};

/// One pass backward for the scores (Koopman & Shephard 1992), with r and N of the backward recursion and, at an update,
/// u = S^-1 y - K' r and D = S^-1 + K' N K:
///
///     R:      1/2 tr[(u u' - D) dR]
///     Q, P0:  1/2 tr[(r r' - N) dQ]
///     x0:     -r' dx0
///     Phi:    tr[(r r' - N) dPhi P Phi'] - r' dPhi x,    r and N after the transition, P and x before it
///
/// and one forward for the average information (Gilmour, Thompson & Cullis 1995), 1/2 f_i' V^-1 f_j with f_i = dV_i V^-1 y and
/// V the covariance of all measurements. The effect of the parameters on the nominal trajectory, about which the filter is
/// linearised, is not included.
[[nodiscard]] NoiseScores noise_scores(const PassRecord& pass, const NoiseModel& model);

}  // namespace coast::estimate
