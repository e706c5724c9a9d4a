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
/// Covariance of a state whose position is a fix less the lever arm, r = fix - C l + v d: it has the errors of what is
/// estimated of the antenna, dr <- dr - C dl + v dd - db, with the lever arm l, the time offset d and the common error b of all
/// fixes. Taken as independent, a position of 2 cm would tell the lever arm to 2 cm. `nav` is where it begins; what the
/// rotation of the arm adds to the velocity of the antenna is left out.
void tie_position_to_fixes(const StateLayout& layout, const record::NavState& nav, Eigen::MatrixXd& P);
/// Transforms the navigation covariance (e-frame, 9 x 9) to N, E, D at the position.
[[nodiscard]] record::NavCovariance nav_covariance_n(const Eigen::Ref<const Eigen::Matrix<double, kNav, kNav>>& P,
                                                     const Eigen::Vector3d& r_eb_e);

}  // namespace coast::estimate
