#include "bench/naive_ekf.hpp"

#include <Eigen/Cholesky>

#include "coast/geo/rotation.hpp"

namespace coast::bench {

namespace {
constexpr int kPos = 0;
constexpr int kVel = 3;
constexpr int kPsi = 6;
constexpr int kBiasG = 9;
constexpr int kBiasA = 12;
constexpr int kScaleG = 15;
constexpr int kScaleA = 18;
constexpr int kNoises = 18;

Eigen::Vector3d earth_rate_e() {
  return {0.0, 0.0, geo::kEarthRate};
}
}  // namespace

NaiveEkf::NaiveEkf(const NaiveModel& model, const NaiveStart& start, const Eigen::Vector3d& lever_arm_b)
    : model_(model), lever_arm_b_(lever_arm_b), nav_(start.nav), P_(kStates, kStates), Q_c_(kNoises, kNoises) {
  const auto square3 = [](double sd) { return Eigen::Vector3d::Constant(sd * sd).eval(); };
  Eigen::VectorXd variance(kStates);
  variance << square3(start.position_sd), square3(start.velocity_sd), square3(start.attitude_sd), square3(model.gyro_bias_sd),
      square3(model.accel_bias_sd), square3(model.gyro_scale_sd), square3(model.accel_scale_sd);
  P_ = variance.asDiagonal();
  // A stationary Gauss-Markov process of variance s^2 is driven with density 2 s^2 / T.
  const double drive = 2.0 / model.correlation_time;
  Eigen::VectorXd density(kNoises);
  density << square3(model.velocity_random_walk), square3(model.angle_random_walk), square3(model.gyro_bias_sd) * drive,
      square3(model.accel_bias_sd) * drive, square3(model.gyro_scale_sd) * drive, square3(model.accel_scale_sd) * drive;
  Q_c_ = density.asDiagonal();
}

void NaiveEkf::propagate(const record::ImuSample& sample) {
  const double dt = sample.dt;
  const Eigen::Vector3d one = Eigen::Vector3d::Ones();
  const Eigen::Vector3d dtheta = (sample.dtheta - bias_g_ * dt).cwiseQuotient(one + scale_g_);
  const Eigen::Vector3d dv = (sample.dv - bias_a_ * dt).cwiseQuotient(one + scale_a_);

  const Eigen::MatrixXd F = dynamics(dtheta / dt, dv / dt);
  const Eigen::MatrixXd G = noise_input();
  const Eigen::MatrixXd Phi = Eigen::MatrixXd::Identity(kStates, kStates) + F * dt;
  const Eigen::MatrixXd Q = G * Q_c_ * G.transpose();
  const Eigen::MatrixXd Q_d = 0.5 * dt * (Phi * Q * Phi.transpose() + Q);

  strapdown(dtheta, dv, dt);
  nav_.t = sample.t;
  P_ = Phi * P_ * Phi.transpose() + Q_d;
}

// Coning and sculling by two samples of one length (Savage 1998), Coriolis and gravity at the start of the interval.
void NaiveEkf::strapdown(const Eigen::Vector3d& dtheta, const Eigen::Vector3d& dv, double dt) {
  const Eigen::Vector3d phi = dtheta + previous_dtheta_.cross(dtheta) / 12.0;
  const Eigen::Vector3d u = dv + 0.5 * dtheta.cross(dv) + (previous_dtheta_.cross(dv) + previous_dv_.cross(dtheta)) / 12.0;
  previous_dtheta_ = dtheta;
  previous_dv_ = dv;

  const Eigen::Vector3d earth = earth_rate_e();
  const Eigen::Vector3d dv_e = nav_.q_b_e * u - 0.5 * dt * earth.cross(nav_.q_b_e * u);
  const Eigen::Vector3d v_before = nav_.v_eb_e;
  const Eigen::Vector3d middle = nav_.r_eb_e + 0.5 * dt * v_before;
  nav_.v_eb_e += dv_e + dt * (geo::gravity_e(middle) - 2.0 * earth.cross(v_before + 0.5 * dv_e));
  nav_.r_eb_e += 0.5 * dt * (v_before + nav_.v_eb_e);
  nav_.q_b_e = geo::quaternion_from_rotation_vector(-earth * dt) * nav_.q_b_e * geo::quaternion_from_rotation_vector(phi);
  nav_.q_b_e.normalize();
}

// Groves (2013, 2nd ed.) eq. (14.49) with psi = error of the estimate: C(estimate) = (I + [psi x]) C(truth).
Eigen::MatrixXd NaiveEkf::dynamics(const Eigen::Vector3d& omega_ib_b, const Eigen::Vector3d& f_ib_b) const {
  const Eigen::Matrix3d C_b_e = nav_.q_b_e.toRotationMatrix();
  const Eigen::Matrix3d earth = geo::skew(earth_rate_e());
  const double r = nav_.r_eb_e.norm();
  const Eigen::Vector3d up = nav_.r_eb_e / r;

  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(kStates, kStates);
  F.block<3, 3>(kPos, kVel).setIdentity();
  // Gradient of a point mass with the local gravity: enough for a peer.
  F.block<3, 3>(kVel, kPos) = -9.8 / r * (Eigen::Matrix3d::Identity() - 3.0 * up * up.transpose());
  F.block<3, 3>(kVel, kVel) = -2.0 * earth;
  F.block<3, 3>(kVel, kPsi) = -geo::skew(C_b_e * f_ib_b);
  F.block<3, 3>(kVel, kBiasA) = -C_b_e;
  F.block<3, 3>(kVel, kScaleA) = -C_b_e * f_ib_b.asDiagonal();
  F.block<3, 3>(kPsi, kPsi) = -earth;
  F.block<3, 3>(kPsi, kBiasG) = -C_b_e;
  F.block<3, 3>(kPsi, kScaleG) = -C_b_e * omega_ib_b.asDiagonal();
  for (int i = kBiasG; i < kStates; ++i) F(i, i) = -1.0 / model_.correlation_time;
  return F;
}

Eigen::MatrixXd NaiveEkf::noise_input() const {
  const Eigen::Matrix3d C_b_e = nav_.q_b_e.toRotationMatrix();
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(kStates, kNoises);
  G.block<3, 3>(kVel, 0) = C_b_e;
  G.block<3, 3>(kPsi, 3) = C_b_e;
  G.block<12, 12>(kBiasG, 6).setIdentity();
  return G;
}

void NaiveEkf::update(const record::GnssFix& fix) {
  const Eigen::Vector3d lever_e = nav_.q_b_e * lever_arm_b_;
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(nav_.r_eb_e));
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, kStates);  // of estimate - measurement
  H.block<3, 3>(0, kPos).setIdentity();
  H.block<3, 3>(0, kPsi) = -geo::skew(lever_e);
  const Eigen::MatrixXd R = C_n_e * fix.position_cov_n * C_n_e.transpose();
  const Eigen::VectorXd z = nav_.r_eb_e + lever_e - fix.r_ea_e;

  const Eigen::MatrixXd S = H * P_ * H.transpose() + R;
  const Eigen::MatrixXd K = P_ * H.transpose() * S.inverse();
  const Eigen::MatrixXd L = Eigen::MatrixXd::Identity(kStates, kStates) - K * H;
  P_ = L * P_ * L.transpose() + K * R * K.transpose();
  feed_back(K * z);
}

void NaiveEkf::feed_back(const Eigen::VectorXd& dx) {
  nav_.r_eb_e -= dx.segment<3>(kPos);
  nav_.v_eb_e -= dx.segment<3>(kVel);
  nav_.q_b_e = geo::quaternion_from_rotation_vector(-dx.segment<3>(kPsi)) * nav_.q_b_e;
  nav_.q_b_e.normalize();
  bias_g_ -= dx.segment<3>(kBiasG);
  bias_a_ -= dx.segment<3>(kBiasA);
  scale_g_ -= dx.segment<3>(kScaleG);
  scale_a_ -= dx.segment<3>(kScaleA);
}

}  // namespace coast::bench
