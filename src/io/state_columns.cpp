#include "state_columns.hpp"

#include <Eigen/Geometry>
#include <utility>

#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

/// Standard deviations and correlations of one vector.
void put_block(TextBuffer& text, const Eigen::Matrix3d& cov, double unit, int decimals) {
  const Eigen::Vector3d sd = cov.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (const double s : sd) put_column(text, s * unit, decimals);
  for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    const double product = sd[i] * sd[j];
    put_column(text, product > 0.0 ? cov(i, j) / product : 0.0, 6);
  }
}

}  // namespace

LocalState local_state(const record::NavState& nav) {
  LocalState s;
  s.p = geo::geodetic_from_ecef(nav.r_eb_e);
  const Eigen::Matrix3d C_e_n = geo::C_n_e(s.p).transpose();
  s.v_eb_n = C_e_n * nav.v_eb_e;
  s.attitude = geo::euler_from_dcm(C_e_n * nav.q_b_e.toRotationMatrix());
  return s;
}

void put_column(TextBuffer& text, double value, int decimals) {
  text.put(',');
  text.put_fixed(value, decimals);
}

void put_time_and_place(TextBuffer& text, geo::GpsTime t, const geo::Geodetic& p) {
  text.put_integer(t.week());
  put_column(text, t.sow(), 9);
  put_column(text, p.latitude / geo::kDegree, 11);
  put_column(text, p.longitude / geo::kDegree, 11);
  put_column(text, p.height, 5);
}

void put_motion(TextBuffer& text, const LocalState& state) {
  for (const double v : state.v_eb_n) put_column(text, v, 6);
  for (const double angle : {state.attitude.roll, state.attitude.pitch, state.attitude.yaw})
    put_column(text, angle / geo::kDegree, 9);
}

void put_covariance(TextBuffer& text, const record::NavCovariance& cov, const geo::Euler& attitude) {
  put_block(text, cov.position, 1.0, 6);
  put_block(text, cov.velocity, 1.0, 7);
  const Eigen::Matrix3d J = geo::euler_jacobian(attitude);
  put_block(text, J * cov.attitude * J.transpose(), 1.0 / geo::kDegree, 8);
}

}  // namespace coast::io
