#pragma once
// Measurements. Each kind is one file in src/estimate/updates: it linearises at the current state, or returns nothing if it
// does not apply. Sign: innovation nu = z - h(estimate) = -H d + noise, with d the error estimate - truth.

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "coast/estimate/filter_state.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"

namespace coast::estimate {

enum class UpdateKind {
  kGnssPosition,
  kGnssVelocity,
  kZeroVelocity,
  kNonHolonomic,
  kCarrierPhase,
  kMemberDifference,
  kHeadingHold,
  kAid
};
[[nodiscard]] std::string_view name(UpdateKind kind);
/// Whether it observes the position.
[[nodiscard]] constexpr bool is_position(UpdateKind kind) {
  return kind == UpdateKind::kGnssPosition || kind == UpdateKind::kCarrierPhase;
}

/// No measurement has more components than this, so that m x m matrices need no heap memory.
inline constexpr int kMaxComponents = 3;
using Components = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxComponents, 1>;
using ComponentCov = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxComponents, kMaxComponents>;

/// A linearised measurement of m components, 1 to 3.
struct Linearised {
  UpdateKind kind = UpdateKind::kGnssPosition;
  Components nu;      ///< m
  Eigen::MatrixXd H;  ///< m x n
  ComponentCov R;     ///< m x m, positive definite
  /// Covariance of the errors d with the measurement's noise, n x m, where its noise is also in the state; empty: none.
  Eigen::MatrixXd M = {};
};

/// Input of every update besides the filter's state.
struct UpdateContext {
  const StateLayout& layout;
  Eigen::Vector3d lever_arm_b;  ///< as configured; the estimated correction is in the state
  Eigen::Vector3d omega_eb_b;   ///< angular rate relative to the Earth, rad/s
  Eigen::Matrix3d C_n_e;        ///< at the position
};

/// GNSS position at the antenna.   z = r + C l + gnss error + base offset - v_a t_offset
[[nodiscard]] Linearised gnss_position(const FilterState& state, const UpdateContext& context, const record::GnssFix& fix);
/// GNSS velocity at the antenna.   z = v + C (omega x l)
[[nodiscard]] std::optional<Linearised> gnss_velocity(const FilterState& state, const UpdateContext& context,
                                                      const record::GnssFix& fix);
/// Zero velocity at standstill.   0 = v_eb
[[nodiscard]] Linearised zero_velocity(const FilterState& state, double sd_mps);

/// Heading at rest does not change:  0 = change of heading since the knot before. The change is the integral of the gyros, so
/// their noise in it is that of the state too (M).
struct RestInterval {
  Eigen::Quaterniond q_b_e;                      ///< attitude at its beginning, after the updates there
  double seconds = 0.0;                          ///< its length
  Eigen::Matrix<double, 3, Eigen::Dynamic> Phi;  ///< transition of the attitude over it, 3 x columns
  Eigen::Matrix<double, kNav, 3> Q_psi;  ///< covariance of the navigation states with the gyros' white noise in the attitude
};
/// @param sd_rad_rts  random walk of the heading that the vehicle is allowed, rad/sqrt(s)
[[nodiscard]] Linearised heading_hold(const FilterState& state, const UpdateContext& context, const RestInterval& interval,
                                      double sd_rad_rts);

/// A car's wheels neither slide sideways nor leave the road at `point_b`:  0 = rows y, z of C_b_v (C_e_b v + omega x p).
struct NonHolonomic {
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  ///< m, body axes
  double sd_lateral_mps = 0.1;
  double sd_vertical_mps = 0.1;
  double pitch = 0.0;  ///< as configured, vehicle relative to body, rad: C_v_b = Rz(yaw) Ry(pitch)
  double yaw = 0.0;
};
[[nodiscard]] Linearised non_holonomic(const FilterState& state, const UpdateContext& context, const NonHolonomic& constraint);
/// Body to vehicle axes. @param pitch, yaw  of the vehicle relative to the body, rad
[[nodiscard]] Eigen::Matrix3d C_b_v_of(double pitch, double yaw);
/// Derivative of C_b_v u with respect to the vehicle's pitch and yaw relative to the body: columns in m/s per rad, rows y and
/// z.
/// @param u_b  velocity of the constraint point, body axes, m/s
[[nodiscard]] Eigen::Matrix2d slip_by_mounting(double pitch, double yaw, const Eigen::Vector3d& u_b);

/// Difference of member j of a synthetic IMU from the members before it; each member has its own error states:
///     mean_j = weighted mean of members 0 .. j-1 over the block
/// on three axes, gyros or accelerometers. The differences of a block are independent of each other and of the noise of the
/// sum.
/// @param block  its members in the order of the layout
/// @return  nothing if member j, or all before it, are not usable
[[nodiscard]] std::optional<Linearised> member_difference(const FilterState& state, const StateLayout& layout,
                                                          const record::MemberBlocks::Block& block, noise::Sensor sensor,
                                                          std::size_t j);

/// An applied update, as needed by the backward recursion.
struct AppliedUpdate {
  UpdateKind kind = UpdateKind::kGnssPosition;
  Eigen::MatrixXd H;   ///< m x n
  Eigen::MatrixXd K;   ///< n x m
  ComponentCov S_inv;  ///< m x m
  Components y;        ///< -nu, m
};

/// Innovation with its covariance, before it is used.
struct Innovation {
  ComponentCov S;       ///< m x m
  Eigen::MatrixXd PHt;  ///< n x m, covariance of d with -nu: P H', less M
  double nis = 0.0;     ///< nu' S^-1 nu
  double log_likelihood = 0.0;
};
/// @throws NumericalError S is not positive definite
[[nodiscard]] Innovation innovation(const FilterState& state, const Linearised& measurement);
/// Corrects state and covariance (Joseph's form, expanded for a narrow gain) and returns the record for the smoother.
[[nodiscard]] AppliedUpdate apply(const Linearised& measurement, const Innovation& innovation, FilterState& state);

}  // namespace coast::estimate
