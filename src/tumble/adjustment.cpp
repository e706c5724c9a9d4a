#include "adjustment.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::tumble {

namespace {

/// Keeps the equations regular where neither fix nor turn tells the heading, rad; it draws nothing towards zero, since the
/// attitude is linearised anew in every step.
constexpr double kAttitudeStep = 1.0;

Eigen::Vector3d earth_rate_n(const Options& options) {
  if (!options.latitude) return Eigen::Vector3d::Zero();
  return geo::kEarthRate * Eigen::Vector3d(std::cos(*options.latitude), 0.0, -std::sin(*options.latitude));
}

Observation force(const Rest& rest, std::size_t index, const State& state) {
  const Common& common = state.common;
  const Eigen::Matrix3d C_n_b = state.poses[index].C_b_n.transpose();
  const Eigen::Vector3d up(0.0, 0.0, -common.gravity);
  const Eigen::Vector3d truth = C_n_b * up;
  const Eigen::Matrix3d gain = Eigen::Matrix3d::Identity() + common.accel_gain;
  Observation o;
  o.kind = Kind::kForce;
  o.rest = index;
  o.residual = rest.accel - gain * truth - common.accel_bias;
  o.common.middleCols<3>(Common::kAccelBias).setIdentity();
  for (int k = 0; k < 6; ++k) {
    const auto [row, column] = kSymmetric[static_cast<std::size_t>(k)];
    o.common(row, Common::kAccelGain + k) += truth[column];
    if (row != column) o.common(column, Common::kAccelGain + k) += truth[row];
  }
  o.common.col(Common::kGravity) = gain * truth / common.gravity;
  o.own.leftCols<3>() = gain * C_n_b * geo::skew(up);
  o.white = rest.accel_variance;
  o.shape = 1.0;
  return o;
}

Observation rate(const Rest& rest, std::size_t index, const Options& options, const State& state) {
  const Eigen::Matrix3d C_n_b = state.poses[index].C_b_n.transpose();
  const Eigen::Vector3d earth = earth_rate_n(options);
  const Eigen::Vector3d truth = C_n_b * earth;
  const Eigen::Matrix3d gain = Eigen::Matrix3d::Identity() + state.common.gyro_gain;
  Observation o;
  o.kind = Kind::kRate;
  o.rest = index;
  o.residual = rest.gyro - gain * truth - state.poses[index].gyro_bias;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) o.common(row, Common::kGyroGain + 3 * row + column) = truth[column];
  o.own.leftCols<3>() = gain * C_n_b * geo::skew(earth);
  o.own.rightCols<3>().setIdentity();
  // Where the latitude is not stated the Earth's rate, in unknown directions, is one more noise of the bias.
  const double unknown = options.latitude ? 0.0 : geo::kEarthRate * geo::kEarthRate / 3.0;
  o.white = rest.gyro_variance.array() + unknown;
  return o;
}

Observation turn_between(const Turn& turn, const Rest& before, std::size_t index, const State& state) {
  const Pose& own = state.poses[index];
  const Pose& next = state.poses[index + 1];
  Observation o;
  o.kind = Kind::kTurn;
  o.rest = index;
  o.pair = true;
  const Eigen::Matrix3d C = own.C_b_n.transpose() * next.C_b_n;
  o.residual = geo::rotation_vector(Eigen::Quaterniond(Eigen::Matrix3d(turn.C * C.transpose())));
  o.common.middleCols<9>(Common::kGyroGain) = -turn.by_gain;
  o.own.leftCols<3>() = -own.C_b_n.transpose();
  o.next.leftCols<3>() = own.C_b_n.transpose();
  o.own.rightCols<3>() = -turn.by_bias_before;
  o.next.rightCols<3>() = -turn.by_bias_after;
  // Angle random walk, from the scatter of the mean of the rest before; the turn mixes the axes.
  o.white.setConstant(before.gyro_variance.mean() * before.length() * turn.duration);
  o.shape = turn.turned * turn.turned;
  return o;
}

Observation walk(const std::vector<Rest>& rests, std::size_t index, const State& state) {
  Observation o;
  o.kind = Kind::kWalk;
  o.rest = index;
  o.pair = true;
  o.residual = state.poses[index].gyro_bias - state.poses[index + 1].gyro_bias;
  o.own.rightCols<3>() = -Eigen::Matrix3d::Identity();
  o.next.rightCols<3>().setIdentity();
  o.shape = 0.5 * (rests[index + 1].from + rests[index + 1].to - rests[index].from - rests[index].to);
  // A hundredth of the noise of a rest, so that the level may be zero.
  o.white = 0.01 * (rests[index].gyro_variance + rests[index + 1].gyro_variance);
  return o;
}

}  // namespace

std::vector<Observation> linearised(const record::ImuRecording& sensor, const std::vector<Rest>& rests, const Options& options,
                                    const State& state, std::vector<Turn>& turns) {
  std::vector<Observation> observations;
  turns.clear();
  for (std::size_t i = 0; i < rests.size(); ++i) {
    observations.push_back(force(rests[i], i, state));
    observations.push_back(rate(rests[i], i, options, state));
    if (i + 1 == rests.size()) break;
    const Eigen::Vector3d earth = state.poses[i].C_b_n.transpose() * earth_rate_n(options);
    turns.push_back(integrate(sensor, rests[i].last + 1, rests[i + 1].first - 1,
                              {state.common.gyro_gain, state.poses[i].gyro_bias, state.poses[i + 1].gyro_bias}, earth));
    observations.push_back(turn_between(turns.back(), rests[i], i, state));
    observations.back().used = turns.back().whole && turns.back().duration <= options.longest_turn;
    observations.push_back(walk(rests, i, state));
  }
  return observations;
}

Eigen::Vector3d noise(const Observation& observation, const Variances& levels) {
  return observation.white.array() + levels[static_cast<std::size_t>(observation.kind)] * observation.shape;
}

Solution solve(const std::vector<Observation>& observations, const Options& options, const State& state,
               const Variances& levels) {
  const auto unknowns = static_cast<Eigen::Index>(Common::kCount + Pose::kCount * state.poses.size());
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(unknowns);
  N(Common::kGravity, Common::kGravity) += 1.0 / (options.gravity_sd * options.gravity_sd);
  b(Common::kGravity) += (options.gravity - state.common.gravity) / (options.gravity_sd * options.gravity_sd);
  for (const Observation& o : observations) {
    if (!o.used) continue;
    const Eigen::Vector3d weight = noise(o, levels).cwiseInverse();
    const auto own = static_cast<Eigen::Index>(Common::kCount + Pose::kCount * o.rest);
    Eigen::Matrix<double, 3, Common::kCount + 2 * Pose::kCount> H;
    H << o.common, o.own, o.next;
    const Eigen::Matrix<double, Common::kCount + 2 * Pose::kCount, 3> HtW = H.transpose() * weight.asDiagonal();
    const Eigen::Matrix<double, Common::kCount + 2 * Pose::kCount, Common::kCount + 2 * Pose::kCount> M = HtW * H;
    const Eigen::Matrix<double, Common::kCount + 2 * Pose::kCount, 1> v = HtW * o.residual;
    const Eigen::Index poses = o.pair ? 2 * Pose::kCount : Pose::kCount;
    N.topLeftCorner<Common::kCount, Common::kCount>() += M.topLeftCorner<Common::kCount, Common::kCount>();
    N.block(0, own, Common::kCount, poses) += M.block(0, Common::kCount, Common::kCount, poses);
    N.block(own, 0, poses, Common::kCount) += M.block(Common::kCount, 0, poses, Common::kCount);
    N.block(own, own, poses, poses) += M.block(Common::kCount, Common::kCount, poses, poses);
    b.head<Common::kCount>() += v.head<Common::kCount>();
    b.segment(own, poses) += v.segment(Common::kCount, poses);
  }
  for (std::size_t i = 0; i < state.poses.size(); ++i)
    N.diagonal().segment<3>(static_cast<Eigen::Index>(Common::kCount + Pose::kCount * i)).array() +=
        1.0 / (kAttitudeStep * kAttitudeStep);
  // Units differ by orders of magnitude: the equations are scaled to a unit diagonal.
  const Eigen::VectorXd scale = N.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  N = (scale.asDiagonal() * N * scale.asDiagonal()).eval();
  N.diagonal().array() += 1e-13;
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(N);
  Solution solution;
  solution.covariance = scale.asDiagonal() * ldlt.solve(Eigen::MatrixXd::Identity(unknowns, unknowns)) * scale.asDiagonal();
  solution.change = scale.asDiagonal() * ldlt.solve(Eigen::VectorXd(scale.asDiagonal() * b));
  return solution;
}

void add(State& state, const Eigen::VectorXd& change) {
  Common& common = state.common;
  common.accel_bias += change.segment<3>(Common::kAccelBias);
  for (int k = 0; k < 6; ++k) {
    const auto [row, column] = kSymmetric[static_cast<std::size_t>(k)];
    common.accel_gain(row, column) += change[Common::kAccelGain + k];
    common.accel_gain(column, row) = common.accel_gain(row, column);
  }
  common.gravity += change[Common::kGravity];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) common.gyro_gain(row, column) += change[Common::kGyroGain + 3 * row + column];
  for (std::size_t i = 0; i < state.poses.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(Common::kCount + Pose::kCount * i);
    state.poses[i].C_b_n = geo::orthonormalised(geo::rotation_matrix(change.segment<3>(at)) * state.poses[i].C_b_n);
    state.poses[i].gyro_bias += change.segment<3>(at + 3);
  }
}

Eigen::Matrix3d predicted(const Observation& o, const Eigen::MatrixXd& covariance) {
  const auto own = static_cast<Eigen::Index>(Common::kCount + Pose::kCount * o.rest);
  const Eigen::Index poses = o.pair ? 2 * Pose::kCount : Pose::kCount;
  constexpr Eigen::Index kAll = Common::kCount + 2 * Pose::kCount;
  Eigen::Matrix<double, 3, kAll> H;
  H << o.common, o.own, o.next;
  Eigen::Matrix<double, kAll, kAll> P = Eigen::Matrix<double, kAll, kAll>::Zero();
  P.topLeftCorner<Common::kCount, Common::kCount>() = covariance.topLeftCorner<Common::kCount, Common::kCount>();
  P.block(0, Common::kCount, Common::kCount, poses) = covariance.block(0, own, Common::kCount, poses);
  P.block(Common::kCount, 0, poses, Common::kCount) = covariance.block(own, 0, poses, Common::kCount);
  P.block(Common::kCount, Common::kCount, poses, poses) = covariance.block(own, own, poses, poses);
  return H * P * H.transpose();
}

}  // namespace coast::tumble
