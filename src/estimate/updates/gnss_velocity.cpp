#include "antenna.hpp"

namespace coast::estimate {

std::optional<Linearised> gnss_velocity(const FilterState& state, const UpdateContext& context, const record::GnssFix& fix) {
  if (!fix.velocity) return std::nullopt;
  const Antenna a = antenna(state, context);
  Linearised m;
  m.kind = UpdateKind::kGnssVelocity;
  m.H = Eigen::MatrixXd::Zero(3, context.layout.size());
  add_antenna_velocity(a, context, 1.0, m.H);
  m.nu = context.C_n_e * fix.velocity->v_ea_n - state.nav.v_eb_e - a.v_ba_e;
  m.R = context.C_n_e * fix.velocity->cov_n * context.C_n_e.transpose();
  return m;
}

}  // namespace coast::estimate
