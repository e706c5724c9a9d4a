#include "antenna.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::estimate {

Linearised gnss_position(const FilterState& state, const UpdateContext& context, const record::GnssFix& fix) {
  const StateLayout& layout = context.layout;
  const Antenna a = antenna(state, context);

  Linearised m;
  m.kind = UpdateKind::kGnssPosition;
  m.H = Eigen::MatrixXd::Zero(3, layout.size());
  Eigen::Vector3d predicted = state.nav.r_eb_e + a.l_ba_e;
  m.H.block<3, 3>(0, kPos).setIdentity();
  m.H.block<3, 3>(0, kPsi) = -geo::skew(a.l_ba_e);  // C(est) l = C l + psi x C l
  if (layout.lever_arm()) m.H.block<3, 3>(0, *layout.lever_arm()) = a.C_b_e;
  if (layout.time_offset()) {  // a fix tagged t is valid at t - d
    const Eigen::Vector3d v_ea_e = state.nav.v_eb_e + a.v_ba_e;
    const double offset = state.x(*layout.time_offset());
    predicted -= offset * v_ea_e;
    m.H.col(*layout.time_offset()) = -v_ea_e;
    add_antenna_velocity(a, context, -offset, m.H);
  }
  if (layout.gnss_error()) {
    predicted += context.C_n_e * state.x.segment<3>(*layout.gnss_error());
    m.H.block<3, 3>(0, *layout.gnss_error()) = context.C_n_e;
  }
  m.nu = fix.r_ea_e - predicted;
  m.R = context.C_n_e * fix.position_cov_n * context.C_n_e.transpose();
  return m;
}

}  // namespace coast::estimate
