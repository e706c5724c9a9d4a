#pragma once

#include <Eigen/Core>

#include "coast/estimate/state_layout.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::estimate {

/// Best estimate and covariance at one instant. `x` holds the estimated sensor and auxiliary states; its first kNav elements
/// are unused and zero (position, velocity and attitude live in `nav`). P is the covariance of the errors, estimate - truth.
struct FilterState {
  record::NavState nav;
  Eigen::VectorXd x;
  Eigen::MatrixXd P;
};

/// Correction: subtracts the error estimate d from nav and x. Attitude by the exact rotation exp(-[psi x]).
void remove_error(const Eigen::VectorXd& d, record::NavState& nav, Eigen::VectorXd& x);
/// The error d (kNav elements), `estimate` - `truth`: position, velocity, rotation vector psi_e.
[[nodiscard]] Eigen::Matrix<double, kNav, 1> error_between(const record::NavState& estimate, const record::NavState& truth);
/// Covariance of a state whose position comes from fixes: it has the common error of all fixes, dr <- dr - db. Does nothing if
/// the layout has no base offset.
void tie_position_to_fixes(const StateLayout& layout, Eigen::MatrixXd& P);
/// Transforms the navigation covariance (e-frame, 9 x 9) to N, E, D at the position.
[[nodiscard]] record::NavCovariance nav_covariance_n(const Eigen::Ref<const Eigen::Matrix<double, kNav, kNav>>& P,
                                                     const Eigen::Vector3d& r_eb_e);

}  // namespace coast::estimate
