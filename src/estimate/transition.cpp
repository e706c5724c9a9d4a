#include "coast/estimate/transition.hpp"

#include <cmath>

#include "coast/geo/rotation.hpp"

namespace coast::estimate {

namespace {

// The response of navigation row i to a constant sensor error grows as elapsed^power.
int response_power(noise::Sensor sensor, int row) {
  const int gyro = row < kVel ? 3 : (row < kPsi ? 2 : 1);
  return sensor == noise::Sensor::kGyro ? gyro : std::max(gyro - 1, 0);
}

}  // namespace

TransitionAccumulator::TransitionAccumulator(const StateLayout& layout, double earth_rate)
    : layout_(layout),
      earth_rate_(earth_rate),
      gyro_noise_b_(layout.gyro_noise_b()),
      accel_noise_b_(layout.accel_noise_b()),
      Phi_n_(kNav, layout.sensor_end()),
      output_(layout.sensor_end() - kNav),
      middle_(output_),
      effect_(3, output_.size()),
      over_half_fold_(layout),
      over_interval_(layout) {
  for (const auto& block : layout.sensors()) {
    multiplicative_ = multiplicative_ || block.signal_b.has_value();
    if (block.sensor == noise::Sensor::kGyro) gyro_states_ += block.size;
  }
  reset();
}

void TransitionAccumulator::reset() {
  Phi_n_.setZero();
  Phi_n_.leftCols<kNav>().setIdentity();
  Q_n_.setZero();
  Q_gyro_.setZero();
  for (NavCov& Q : Q_axes_) Q.setZero();
  for (const auto& block : layout_.sensors()) output_.segment(block.offset - kNav, block.size) = block.output;
  elapsed_ = 0.0;
  clear_pending();
}

void TransitionAccumulator::clear_pending() {
  fold_ = {};
  sum_C_.setZero();
  if (!multiplicative_) return;
  for (std::size_t k = 0; k < 3; ++k) {
    sum_C_dtheta_[k].setZero();
    sum_C_dv_[k].setZero();
  }
}

void TransitionAccumulator::add(const SampleDynamics& s) {
  fold_.add(s);
  sum_C_ += s.dt * s.C_b_e;
  if (!multiplicative_) return;
  for (int k = 0; k < 3; ++k) {
    sum_C_dtheta_[static_cast<std::size_t>(k)] += s.dtheta_b(k) * s.C_b_e;
    sum_C_dv_[static_cast<std::size_t>(k)] += s.dv_b(k) * s.C_b_e;
  }
}

void TransitionAccumulator::add_sensor_columns() {
  over_half_fold_.over(0.5 * fold_.h);
  middle_ = output_;
  over_half_fold_.apply_to_row(middle_);
  output_ = middle_;
  over_half_fold_.apply_to_row(output_);
  for (const auto& block : layout_.sensors()) {
    const bool gyro = block.sensor == noise::Sensor::kGyro;
    Eigen::Vector3d column;  // integral of C times the sensor error per unit of the process's output
    if (block.signal_b) {
      const auto& sums = gyro ? sum_C_dtheta_ : sum_C_dv_;
      const Eigen::Vector3d& s = *block.signal_b;
      column.noalias() =
          s.x() * (sums[0] * block.response_b) + s.y() * (sums[1] * block.response_b) + s.z() * (sums[2] * block.response_b);
    } else {
      column.noalias() = sum_C_ * block.response_b;
    }
    for (int j = block.offset - kNav; j < block.offset - kNav + block.size; ++j) effect_.col(j) = middle_(j) * column;
  }
  const auto accel_states = output_.size() - gyro_states_;
  fold_.add_gyro_errors(Phi_n_.middleCols(kNav, gyro_states_), effect_.leftCols(gyro_states_));
  fold_.add_accel_errors(Phi_n_.rightCols(accel_states), effect_.rightCols(accel_states));
}

namespace {

/// @param q  integral of the density over the fold, e-frame  @param h  its length, s
void add_accel_noise(const Eigen::Matrix3d& q, double h, NavCov& Q) {
  Q.block<3, 3>(kPos, kPos) += (h * h / 3.0) * q;
  Q.block<3, 3>(kPos, kVel) += (h / 2.0) * q;
  Q.block<3, 3>(kVel, kPos) += (h / 2.0) * q;
  Q.block<3, 3>(kVel, kVel) += q;
}

/// @param sum_f_cross  [integral of C f x]
void add_gyro_noise(const Eigen::Matrix3d& q, const Eigen::Matrix3d& sum_f_cross, NavCov& Q) {
  const Eigen::Matrix3d tilted = sum_f_cross * q;
  Q.block<3, 3>(kVel, kVel) += (tilted * sum_f_cross.transpose()) / 3.0;
  Q.block<3, 3>(kVel, kPsi) -= 0.5 * tilted;
  Q.block<3, 3>(kPsi, kVel) -= 0.5 * tilted.transpose();
  Q.block<3, 3>(kPsi, kPsi) += q;
}

}  // namespace

void TransitionAccumulator::add_white_noise() {
  const double h = fold_.h;
  const Eigen::Matrix3d gyro = (sum_C_ * gyro_noise_b_) / std::sqrt(h);  // q = h C N N' C'
  const Eigen::Matrix3d accel = (sum_C_ * accel_noise_b_) / std::sqrt(h);
  const Eigen::Matrix3d sum_f_cross = geo::skew(fold_.sum_f);
  const Eigen::Matrix3d q_g = gyro * gyro.transpose();
  add_accel_noise(accel * accel.transpose(), h, Q_n_);
  add_gyro_noise(q_g, sum_f_cross, Q_n_);
  add_gyro_noise(q_g, sum_f_cross, Q_gyro_);
  if (!splits_) return;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    add_gyro_noise(gyro.col(axis) * gyro.col(axis).transpose(), sum_f_cross, Q_axes_[i]);
    add_accel_noise(accel.col(axis) * accel.col(axis).transpose(), h, Q_axes_[3 + i]);
  }
}

void TransitionAccumulator::fold(const Eigen::Matrix3d& gravity_gradient) {
  if (!(fold_.h > 0.0)) return;
  fold_.advance(Phi_n_, gravity_gradient, earth_rate_);
  add_sensor_columns();
  for_each_covariance([&](NavCov& Q) {
    fold_.advance(Q, gravity_gradient, earth_rate_);
    Q.transposeInPlace();
    fold_.advance(Q, gravity_gradient, earth_rate_);
  });
  add_white_noise();
  elapsed_ += fold_.h;
  clear_pending();
}

void TransitionAccumulator::propagate_covariance(Eigen::MatrixXd& P, bool renews_gnss_error) {
  const auto rest = P.rows() - kNav;
  over_interval_.over(elapsed_, renews_gnss_error);
  NavRows T(kNav, P.cols());
  T.topRows<kPsi>().noalias() = Phi_n_.topRows<kPsi>() * P.topRows(Phi_n_.cols());
  // The attitude depends only on attitude and gyro states.
  T.bottomRows<3>().noalias() = Phi_n_.block<3, 3>(kPsi, kPsi) * P.middleRows<3>(kPsi);
  T.bottomRows<3>().noalias() += Phi_n_.block(kPsi, kNav, 3, gyro_states_) * P.middleRows(kNav, gyro_states_);
  P.topLeftCorner<kNav, kNav>().noalias() = T.leftCols(Phi_n_.cols()) * Phi_n_.transpose();
  P.topLeftCorner<kNav, kNav>() += Q_n_;
  over_interval_.propagate(P.bottomRightCorner(rest, rest));
  P.bottomLeftCorner(rest, kNav) = T.rightCols(rest).transpose();
  over_interval_.apply(P.bottomLeftCorner(rest, kNav));
  P.topRightCorner(kNav, rest) = P.bottomLeftCorner(rest, kNav).transpose();
  add_driven_covariance(P);
}

// Driving noise of sensor states that is uniform over the interval, with responses that grow as powers of time:
// integrals of (t/T)^p and (t/T)^(p+q) over the interval.
void TransitionAccumulator::add_driven_covariance(Eigen::MatrixXd& P) const {
  const auto shares = [](noise::Sensor sensor) {
    Eigen::Matrix<double, kNav, 1> cross;
    NavCov both;
    for (int i = 0; i < kNav; ++i) {
      cross(i) = 1.0 / (response_power(sensor, i) + 1.0);
      for (int j = 0; j < kNav; ++j) both(i, j) = 1.0 / (response_power(sensor, i) + response_power(sensor, j) + 1.0);
    }
    return std::pair(cross, both);
  };
  static const auto gyro_shares = shares(noise::Sensor::kGyro);
  static const auto accel_shares = shares(noise::Sensor::kAccel);
  NavCov driven_g = NavCov::Zero(), driven_a = NavCov::Zero();
  for (const auto& block : layout_.sensors()) {
    const auto Q_d = over_interval_.driving_noise(block);
    if (Q_d.isZero(0.0)) continue;
    const bool gyro = block.sensor == noise::Sensor::kGyro;
    for (int a = 0; a < block.size; ++a) {
      const Eigen::Matrix<double, kNav, 1> response = Phi_n_.col(block.offset + a);
      for (int b = 0; b < block.size; ++b) {
        const double q = Q_d(a, b);
        const int c = block.offset + b;
        const Eigen::Matrix<double, kNav, 1> cross = q * response.cwiseProduct(gyro ? gyro_shares.first : accel_shares.first);
        P.col(c).head<kNav>() += cross;
        P.row(c).head<kNav>() += cross.transpose();
        const Eigen::Matrix<double, kNav, 1> other = q * Phi_n_.col(c);
        (gyro ? driven_g : driven_a).noalias() += response * other.transpose();
      }
    }
  }
  P.topLeftCorner<kNav, kNav>() += driven_g.cwiseProduct(gyro_shares.second) + driven_a.cwiseProduct(accel_shares.second);
}

}  // namespace coast::estimate
