#include "coast/estimate/filter_state.hpp"

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::estimate {

void remove_error(const Eigen::VectorXd& d, record::NavState& nav, Eigen::VectorXd& x) {
  nav.r_eb_e -= d.segment<3>(kPos);
  nav.v_eb_e -= d.segment<3>(kVel);
  nav.q_b_e = (geo::quaternion_from_rotation_vector(-d.segment<3>(kPsi)) * nav.q_b_e).normalized();
  x.tail(x.size() - kNav) -= d.tail(d.size() - kNav);
}

Eigen::Matrix<double, kNav, 1> error_between(const record::NavState& estimate, const record::NavState& truth) {
  Eigen::Matrix<double, kNav, 1> d;
  d.segment<3>(kPos) = estimate.r_eb_e - truth.r_eb_e;
  d.segment<3>(kVel) = estimate.v_eb_e - truth.v_eb_e;
  d.segment<3>(kPsi) = geo::rotation_vector(estimate.q_b_e * truth.q_b_e.conjugate());
  return d;
}

void tie_position_to_fixes(const StateLayout& layout, Eigen::MatrixXd& P) {
  if (!layout.base_offset()) return;
  P.middleRows<3>(kPos) -= P.middleRows<3>(*layout.base_offset()).eval();
  P.middleCols<3>(kPos) -= P.middleCols<3>(*layout.base_offset()).eval();
}

record::NavCovariance nav_covariance_n(const Eigen::Ref<const Eigen::Matrix<double, kNav, kNav>>& P,
                                       const Eigen::Vector3d& r_eb_e) {
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(r_eb_e));
  record::NavCovariance cov;
  cov.position = C_n_e.transpose() * P.block<3, 3>(kPos, kPos) * C_n_e;
  cov.velocity = C_n_e.transpose() * P.block<3, 3>(kVel, kVel) * C_n_e;
  cov.attitude = C_n_e.transpose() * P.block<3, 3>(kPsi, kPsi) * C_n_e;
  return cov;
}

}  // namespace coast::estimate
