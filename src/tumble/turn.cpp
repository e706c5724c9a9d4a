#include "turn.hpp"

#include <Eigen/LU>

#include "coast/geo/rotation.hpp"

namespace coast::tumble {

Turn integrate(const record::ImuRecording& sensor, std::size_t first, std::size_t last, const GyroErrors& errors,
               const Eigen::Vector3d& earth_rate) {
  Turn turn;
  double duration = 0.0;
  for (std::size_t i = first; i <= last; ++i) duration += sensor.samples[i].dt;
  turn.duration = duration;
  const Eigen::Matrix3d correct = (Eigen::Matrix3d::Identity() + errors.gain).inverse();
  const double usual_step = 1.0 / sensor.rate_hz;
  double time = 0.0;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (std::size_t i = first; i <= last; ++i) {
    const record::ImuSample& sample = sensor.samples[i];
    turn.whole = turn.whole && sample.dt < 3.0 * usual_step;
    const double after = (time + 0.5 * sample.dt) / duration;  // share of the bias after the turn
    const Eigen::Vector3d bias = (1.0 - after) * errors.bias_before + after * errors.bias_after;
    const Eigen::Vector3d increment = correct * (sample.dtheta - sample.dt * bias);
    // Two-sample coning: the earlier increment shows how the rate turns within the interval (Savage 1998).
    const Eigen::Vector3d rotation = increment + before.cross(increment) / 12.0 - turn.C.transpose() * earth_rate * sample.dt;
    const Eigen::Matrix3d middle = turn.C * geo::rotation_matrix(0.5 * rotation);
    const Eigen::Matrix3d lever = middle * correct;
    for (Eigen::Index column = 0; column < 3; ++column)
      for (Eigen::Index row = 0; row < 3; ++row) turn.by_gain.col(3 * row + column) -= lever.col(row) * increment[column];
    turn.by_bias_before -= (1.0 - after) * sample.dt * lever;
    turn.by_bias_after -= after * sample.dt * lever;
    turn.turned += increment.norm();
    turn.C = (turn.C * geo::rotation_matrix(rotation)).eval();
    before = increment;
    time += sample.dt;
  }
  return turn;
}

}  // namespace coast::tumble
