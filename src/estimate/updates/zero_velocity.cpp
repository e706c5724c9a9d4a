#include "coast/estimate/update.hpp"

namespace coast::estimate {

Linearised zero_velocity(const FilterState& state, double sd_mps) {
  Linearised m;
  m.kind = UpdateKind::kZeroVelocity;
  m.nu = -state.nav.v_eb_e;
  m.H = Eigen::MatrixXd::Zero(3, state.P.rows());
  m.H.block<3, 3>(0, kVel).setIdentity();
  m.R = sd_mps * sd_mps * Eigen::Matrix3d::Identity();
  return m;
}

}  // namespace coast::estimate
