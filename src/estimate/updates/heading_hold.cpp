#include <Eigen/LU>

#include "coast/estimate/update.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::estimate {

// At rest the attitude relative to the Earth is constant, so that the rotation r between both ends of the interval is that of
// the errors, psi_k - psi_{k-1}. With psi_k = Phi_psi psi_{k-1} + Phi_x x + w and constant x,
//
//     r = (I - Phi_psi^-1) psi_k + Phi_psi^-1 (Phi_x x + w),   0 = u' r + v
//
// about the vertical u. w is in psi_k, so M = E[d n'] with the noise n = -u' Phi_psi^-1 w + v of the innovation.
Linearised heading_hold(const FilterState& state, const UpdateContext& context, const RestInterval& interval,
                        double sd_rad_rts) {
  const Eigen::Vector3d down_e = context.C_n_e.col(2);
  const Eigen::Matrix3d back = interval.Phi.middleCols<3>(kPsi).inverse();
  const Eigen::RowVector3d row = down_e.transpose() * back;
  Linearised m;
  m.kind = UpdateKind::kHeadingHold;
  m.nu = Components::Constant(1, -down_e.dot(geo::rotation_vector(state.nav.q_b_e * interval.q_b_e.conjugate())));
  m.H = Eigen::MatrixXd::Zero(1, context.layout.size());
  m.H.leftCols(interval.Phi.cols()) = row * interval.Phi;
  m.H.block<1, 3>(0, kPsi) = down_e.transpose() - row;
  m.M = Eigen::MatrixXd::Zero(context.layout.size(), 1);
  m.M.topRows<kNav>() = -interval.Q_psi * row.transpose();
  const double of_gyros = row * interval.Q_psi.middleRows<3>(kPsi) * row.transpose();
  m.R = ComponentCov::Constant(1, 1, of_gyros + sd_rad_rts * sd_rad_rts * interval.seconds);
  return m;
}

}  // namespace coast::estimate
