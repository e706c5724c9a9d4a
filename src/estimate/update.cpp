#include "coast/estimate/update.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"

namespace coast::estimate {

std::string_view name(UpdateKind kind) {
  switch (kind) {
    case UpdateKind::kGnssPosition:
      return "gnss_position";
    case UpdateKind::kGnssVelocity:
      return "gnss_velocity";
    case UpdateKind::kZeroVelocity:
      return "zero_velocity";
    case UpdateKind::kNonHolonomic:
      return "non_holonomic";
    case UpdateKind::kCarrierPhase:
      return "carrier_phase";
    case UpdateKind::kMemberDifference:
      return "member_difference";
    case UpdateKind::kHeadingHold:
      return "heading_hold";
    case UpdateKind::kAid:
      return "aid";
  }
  return "";
}

Innovation innovation(const FilterState& state, const Linearised& measurement) {
  Innovation result;
  result.PHt.noalias() = state.P * measurement.H.transpose();
  result.S = measurement.R;
  result.S.noalias() += measurement.H * result.PHt;
  if (measurement.M.size() > 0) {
    // -nu = H d - noise and E[d noise'] = M:  E[d (-nu)'] = P H' - M,  S = H P H' - H M - M' H' + R
    const ComponentCov HM = measurement.H * measurement.M;
    result.S -= HM + HM.transpose();
    result.PHt -= measurement.M;
  }
  const Eigen::LLT<ComponentCov> llt(result.S);
  if (llt.info() != Eigen::Success || !measurement.nu.allFinite())
    throw NumericalError("innovation covariance is not positive definite", geo::to_string(state.nav.t),
                         fmt::format("update {}; the filter has diverged or an input is wrong: check the axes and the sign of "
                                     "gravity, the noise of the error model, and the start",
                                     name(measurement.kind)));
  const Components whitened = llt.matrixL().solve(measurement.nu);
  result.nis = whitened.squaredNorm();
  const double log_det = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  result.log_likelihood = -0.5 * (result.nis + log_det + static_cast<double>(measurement.nu.size()) * std::log(2.0 * geo::kPi));
  return result;
}

namespace {

// Joseph's (I - K H) P (I - K H)' + K R K' with S = H P H' + R, expanded and rearranged:
//     P - K (P H')' - (P H' - K S) K'
// The last bracket is rounding only, and the reason why this form keeps P positive. Lower triangle, then mirrored.
template <int M>
void correct_covariance(const Eigen::Matrix<double, Eigen::Dynamic, M>& PHt, const Eigen::Matrix<double, Eigen::Dynamic, M>& K,
                        const Eigen::Matrix<double, M, M>& S, Eigen::MatrixXd& P) {
  const Eigen::Matrix<double, Eigen::Dynamic, M> rounding = PHt - K * S;
  const auto n = P.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::Index below = n - j;
    P.col(j).tail(below) -=
        K.bottomRows(below).lazyProduct(PHt.row(j).transpose()) + rounding.bottomRows(below).lazyProduct(K.row(j).transpose());
    P.row(j).tail(below) = P.col(j).tail(below).transpose();
  }
}

}  // namespace

AppliedUpdate apply(const Linearised& measurement, const Innovation& innovation, FilterState& state) {
  AppliedUpdate update;
  update.kind = measurement.kind;
  update.H = measurement.H;
  update.y = -measurement.nu;
  const auto m = measurement.nu.size();
  update.S_inv = innovation.S.llt().solve(ComponentCov::Identity(m, m));
  update.K.noalias() = innovation.PHt.lazyProduct(update.S_inv);
  if (m == 3)
    correct_covariance<3>(innovation.PHt, update.K, innovation.S, state.P);
  else if (m == 2)
    correct_covariance<2>(innovation.PHt, update.K, innovation.S, state.P);
  else
    correct_covariance<1>(innovation.PHt, update.K, innovation.S, state.P);
  remove_error(update.K * update.y, state.nav, state.x);
  return update;
}

}  // namespace coast::estimate
