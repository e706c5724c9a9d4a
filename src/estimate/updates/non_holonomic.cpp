#include <cmath>

#include "antenna.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::estimate {

Eigen::Matrix3d C_b_v_of(double pitch, double yaw) {
  return geo::dcm_from_euler({.roll = 0.0, .pitch = pitch, .yaw = yaw}).transpose();
}

// d(C_b_v)/d(pitch) = -[e_y x] C_b_v;   d(C_b_v)/d(yaw) = -C_b_v [e_z x]
Eigen::Matrix2d slip_by_mounting(double pitch, double yaw, const Eigen::Vector3d& u_b) {
  const Eigen::Matrix3d C_b_v = C_b_v_of(pitch, yaw);
  Eigen::Matrix<double, 3, 2> columns;
  columns << -Eigen::Vector3d::UnitY().cross(C_b_v * u_b), -C_b_v * Eigen::Vector3d::UnitZ().cross(u_b);
  return columns.bottomRows<2>();
}

// Vehicle velocity v_v = C_b_v u with u = C_e_b v + omega x p, C_b_v = Ry(pitch)' Rz(yaw)'; rows y and z must be zero.
Linearised non_holonomic(const FilterState& state, const UpdateContext& context, const NonHolonomic& constraint) {
  const StateLayout& layout = context.layout;
  double pitch = constraint.pitch;
  double yaw = constraint.yaw;
  if (layout.mounting()) {
    pitch += state.x(*layout.mounting());
    yaw += state.x(*layout.mounting() + 1);
  }
  const Eigen::Matrix3d C_b_v = C_b_v_of(pitch, yaw);
  const Eigen::Matrix3d C_e_b = state.nav.q_b_e.toRotationMatrix().transpose();
  const Eigen::Vector3d u = C_e_b * state.nav.v_eb_e + context.omega_eb_b.cross(constraint.point_b);

  Linearised m;
  m.kind = UpdateKind::kNonHolonomic;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, layout.size());
  H.block<3, 3>(0, kVel) = C_b_v * C_e_b;
  H.block<3, 3>(0, kPsi) = C_b_v * C_e_b * geo::skew(state.nav.v_eb_e);  // C_e_b(est) v = C_e_b (v - psi x v)
  if (layout.mounting()) H.block<2, 2>(1, *layout.mounting()) = slip_by_mounting(pitch, yaw, u);
  add_rate(-C_b_v * geo::skew(constraint.point_b), context, H);
  m.nu = -(C_b_v * u).tail<2>();
  m.H = H.bottomRows<2>();
  m.R = Eigen::Vector2d(constraint.sd_lateral_mps * constraint.sd_lateral_mps,
                        constraint.sd_vertical_mps * constraint.sd_vertical_mps)
            .asDiagonal();
  return m;
}

}  // namespace coast::estimate
