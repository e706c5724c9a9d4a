#pragma once
// Gauss-Newton steps to an ARMA-GARCH maximum. Private to the room.

#include "arma_garch_coordinates.hpp"

namespace coast::noise {

struct ArmaGarchTop {
  Eigen::VectorXd u;
  double value = 0.0;      ///< log-likelihood
  bool converged = false;  ///< the quadratic model predicts a gain below 1e-10
  int evaluations = 0;
};

/// From u, by steps with Fisher's information (the expected curvature, also for e not normal), damped until the log-likelihood
/// rises (Levenberg 1944, Marquardt 1963). A coordinate at an end of the box that would leave it is held.
[[nodiscard]] ArmaGarchTop climb_arma_garch(ArmaGarchRecursion& recursion, const ArmaGarchCoordinates& coordinates,
                                            const Eigen::VectorXd& u);

}  // namespace coast::noise
