#include "start.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "coast/geo/rotation.hpp"
#include "coast/record/error.hpp"

namespace coast::tumble {

namespace {

/// |f - b|^2 = r^2 is linear in b and in r^2 - b.b.
struct Sphere {
  Eigen::Vector3d centre;
  double radius = 0.0;
};

Sphere sphere_through(const std::vector<Rest>& rests, const std::string& source) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Rest& rest : rests) mean += rest.accel;
  mean /= static_cast<double>(rests.size());
  Eigen::MatrixXd A(static_cast<Eigen::Index>(rests.size()), 4);
  Eigen::VectorXd y(A.rows());
  double size = 0.0;
  for (const Rest& rest : rests) size = std::max(size, (rest.accel - mean).norm());
  for (std::size_t i = 0; i < rests.size(); ++i) {
    const Eigen::Vector3d f = (rests[i].accel - mean) / size;
    A.row(static_cast<Eigen::Index>(i)) << 2.0 * f.transpose(), 1.0;
    y[static_cast<Eigen::Index>(i)] = f.squaredNorm();
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  qr.setThreshold(0.05);
  if (qr.rank() < 4)
    throw InputError(
        {source, 0, fmt::format("{} rests, and all of them in one plane or fewer than four directions", rests.size()),
         "rests with every axis up and down", "Put the IMU down on each of its six sides, and askew between them."});
  const Eigen::Vector4d x = qr.solve(y);
  return {mean + size * x.head<3>(), size * std::sqrt(x[3] + x.head<3>().squaredNorm())};
}

// The rotation, about a horizontal axis, that brings the measured direction of the force to the vertical.
Eigen::Matrix3d levelled(const Eigen::Matrix3d& C_b_n, const Eigen::Vector3d& force) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(C_b_n * force.normalized(), Eigen::Vector3d(0.0, 0.0, -1.0));
  return turn.toRotationMatrix() * C_b_n;
}

Eigen::Vector3d force_at(const Rest& rest, const Common& common) {
  return (rest.accel - common.accel_bias) / (1.0 + common.accel_gain(0, 0));
}

/// A signed permutation of the gyros' axes and a factor on their rates.
struct Reading {
  Eigen::Matrix3d axes;
  double factor = 1.0;
};

/// Median angle, rad, between the vertical that the gyros predict after a turn and the one measured there.
double disagreement(const record::ImuRecording& sensor, const std::vector<Rest>& rests, const Options& options,
                    const State& start, const Reading& reading) {
  std::vector<double> angles;
  for (std::size_t i = 0; i + 1 < rests.size(); ++i) {
    const double between = rests[i + 1].from - rests[i].to;
    if (between > options.longest_turn) continue;
    // measured = (I + gain) true with I + gain = (factor axes)^-1
    const Eigen::Matrix3d gain = reading.axes.transpose() / reading.factor - Eigen::Matrix3d::Identity();
    const Turn turn = integrate(sensor, rests[i].last + 1, rests[i + 1].first - 1, {gain, rests[i].gyro, rests[i + 1].gyro},
                                Eigen::Vector3d::Zero());
    const Eigen::Vector3d predicted = turn.C.transpose() * force_at(rests[i], start.common);
    const Eigen::Vector3d found = force_at(rests[i + 1], start.common);
    angles.push_back(std::atan2(predicted.cross(found).norm(), predicted.dot(found)));
  }
  if (angles.empty()) return 0.0;
  std::ranges::nth_element(angles, angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2));
  return angles[angles.size() / 2];
}

/// Factor on the rates, within a factor of two, with which gyros and accelerometers agree best: the scale of raw counts is
/// known roughly at most.
double best_factor(const record::ImuRecording& sensor, const std::vector<Rest>& rests, const Options& options,
                   const State& start) {
  double best = 1.0;
  double least = disagreement(sensor, rests, options, start, {Eigen::Matrix3d::Identity(), best});
  for (int k = -14; k <= 14; ++k) {
    const double factor = std::pow(1.05, k);
    const double angle = disagreement(sensor, rests, options, start, {Eigen::Matrix3d::Identity(), factor});
    if (angle < 0.9 * least) {
      least = angle;
      best = factor;
    }
  }
  return best;
}

std::vector<Reading> readings() {
  std::vector<Reading> all;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8U; ++signs) {
      Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
      for (int row = 0; row < 3; ++row)
        axes(row, order[static_cast<std::size_t>(row)]) = ((signs >> static_cast<unsigned>(row)) & 1U) != 0U ? -1.0 : 1.0;
      for (const double unit : {1.0, std::numbers::pi / 180.0, 180.0 / std::numbers::pi})
        for (const double factor : {1.0, 0.8, 1.25}) all.push_back({axes, unit * factor});
    }
  } while (std::ranges::next_permutation(order).found);
  return all;
}

std::string in_words(const Reading& reading) {
  std::string axes;
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 3; ++column)
      if (reading.axes(row, column) != 0.0)
        axes += fmt::format("{}{}{}", axes.empty() ? "" : ", ", reading.axes(row, column) < 0.0 ? "-" : "", "xyz"[column]);
  std::string text = fmt::format("as they would with the gyros' axes [{}]", axes);
  if (reading.factor != 1.0) text += fmt::format(" and their rates times {:.4g}", reading.factor);
  return text;
}

}  // namespace

State start_of(const record::ImuRecording& sensor, const std::vector<Rest>& rests, const Options& options, double heading) {
  const Sphere sphere = sphere_through(rests, sensor.source);
  State state;
  state.common.accel_bias = sphere.centre;
  state.common.accel_gain = (sphere.radius / options.gravity - 1.0) * Eigen::Matrix3d::Identity();
  state.common.gravity = options.gravity;
  // The attitudes are needed by nothing that chooses the factor.
  const double factor = best_factor(sensor, rests, options, state);
  state.common.gyro_gain = (1.0 / factor - 1.0) * Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < rests.size(); ++i) {
    Pose pose;
    pose.gyro_bias = rests[i].gyro;
    if (i == 0) {
      pose.C_b_n = geo::rotation_matrix(Eigen::Vector3d(0.0, 0.0, heading));
    } else {
      const Turn turn = integrate(sensor, rests[i - 1].last + 1, rests[i].first - 1,
                                  {state.common.gyro_gain, rests[i - 1].gyro, rests[i].gyro}, Eigen::Vector3d::Zero());
      pose.C_b_n = state.poses.back().C_b_n * turn.C;
    }
    pose.C_b_n = levelled(pose.C_b_n, force_at(rests[i], state.common));
    state.poses.push_back(pose);
  }
  return state;
}

void require_agreement(const record::ImuRecording& sensor, const std::vector<Rest>& rests, const Options& options,
                       const State& start) {
  constexpr double kAgree = 0.35;  // rad; 5 % of scale on a turn by half a circle are 0.16
  const double stated = 1.0 / (1.0 + start.common.gyro_gain(0, 0));
  const double now = disagreement(sensor, rests, options, start, {Eigen::Matrix3d::Identity(), stated});
  if (now < kAgree) return;
  const std::vector<Reading> all = readings();
  std::vector<double> each;
  for (const Reading& reading : all) each.push_back(disagreement(sensor, rests, options, start, reading));
  const auto best = static_cast<std::size_t>(std::ranges::min_element(each) - each.begin());
  const std::string found = fmt::format("after a turn the vertical of gyros and accelerometers differs by {:.0f} deg (median)",
                                        now * 180.0 / std::numbers::pi);
  if (each[best] < kAgree)
    throw InputError(
        {sensor.source, 0, found, "gyros and accelerometers in the same axes, and stated units",
         fmt::format("They agree within {:.1f} deg {}: order, sign and unit of the columns in `imu: columns, scale, units`.",
                     each[best] * 180.0 / std::numbers::pi, in_words(all[best]))});
  throw InputError(
      {sensor.source, 0, found, "gyros and accelerometers of one IMU, at the same time",
       "No order or sign of the axes and no unit mends it: check `columns`, `scale`, `units` and the range of the gyros."});
}

}  // namespace coast::tumble
