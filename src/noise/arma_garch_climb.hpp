#pragma once
// Gauss-Newton steps to an ARMA-GARCH maximum. Private to the room.

#include "arma_garch_coordinates.hpp"

namespace coast::noise {

struct ArmaGarchTop {
  Eigen::VectorXd u;
  double value = 0.0;      ///< log-likelihood
  bool converged = false;  ///< the quadratic model promises less than 1e-10
  int evaluations = 0;
};

/// From u, by steps with Fisher's information (for normal e or not, the expected curvature), damped until the log-likelihood
/// rises (Levenberg 1944, Marquardt 1963). What lies on an end of the box and would leave it stays.
[[nodiscard]] ArmaGarchTop climb_arma_garch(ArmaGarchRecursion& recursion, const ArmaGarchCoordinates& coordinates,
                                            const Eigen::VectorXd& u);

}  // namespace coast::noise
