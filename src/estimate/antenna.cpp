#include "antenna.hpp"

#include "coast/geo/rotation.hpp"

namespace coast::estimate {

Antenna antenna(const FilterState& state, const UpdateContext& context) {
  Antenna a;
  a.l_ba_b = context.lever_arm_b;
  if (context.layout.lever_arm()) a.l_ba_b += state.x.segment<3>(*context.layout.lever_arm());
  a.C_b_e = state.nav.q_b_e.toRotationMatrix();
  a.l_ba_e = a.C_b_e * a.l_ba_b;
  a.v_ba_e = a.C_b_e * context.omega_eb_b.cross(a.l_ba_b);
  return a;
}

AntennaPrediction antenna_position(const FilterState& state, const UpdateContext& context) {
  const StateLayout& layout = context.layout;
  const Antenna a = antenna(state, context);
  AntennaPrediction p{state.nav.r_eb_e + a.l_ba_e, Eigen::MatrixXd::Zero(3, layout.size())};
  p.H.block<3, 3>(0, kPos).setIdentity();
  p.H.block<3, 3>(0, kPsi) = -geo::skew(a.l_ba_e);  // C(est) l = C l + psi x C l
  if (layout.lever_arm()) p.H.block<3, 3>(0, *layout.lever_arm()) = a.C_b_e;
  if (layout.time_offset()) {  // a fix tagged t is valid at t - d
    const Eigen::Vector3d v_ea_e = state.nav.v_eb_e + a.v_ba_e;
    const double offset = state.x(*layout.time_offset());
    p.value_e -= offset * v_ea_e;
    p.H.col(*layout.time_offset()) = -v_ea_e;
    add_antenna_velocity(a, context, -offset, p.H);
  }
  return p;
}

AntennaPrediction antenna_velocity(const FilterState& state, const UpdateContext& context) {
  const Antenna a = antenna(state, context);
  AntennaPrediction p{state.nav.v_eb_e + a.v_ba_e, Eigen::MatrixXd::Zero(3, context.layout.size())};
  add_antenna_velocity(a, context, 1.0, p.H);
  return p;
}

void add_antenna_velocity(const Antenna& a, const UpdateContext& context, double factor, Eigen::MatrixXd& H) {
  H.block<3, 3>(0, kVel).diagonal().array() += factor;
  H.block<3, 3>(0, kPsi) -= factor * geo::skew(a.v_ba_e);
  if (context.layout.lever_arm())
    H.block<3, 3>(0, *context.layout.lever_arm()) += factor * a.C_b_e * geo::skew(context.omega_eb_b);
  add_rate(-factor * a.C_b_e * geo::skew(a.l_ba_b), context, H);
}

void add_rate(const Eigen::Matrix3d& A, const UpdateContext& context, Eigen::MatrixXd& H) {
  for (const auto& block : context.layout.sensors()) {
    if (block.sensor != noise::Sensor::kGyro) continue;
    // omega(est) = omega - response * input * de: the gyro's estimated additive errors are already subtracted from the rate.
    const double input = block.signal_b ? block.signal_b->dot(context.omega_eb_b) : 1.0;
    const Eigen::Vector3d column = -input * (A * block.response_b);
    H.middleCols(block.offset, block.size) += column * block.output;
  }
}

}  // namespace coast::estimate
