#pragma once
// An IMU that is put down in random poses and turned by hand between them, from its own equations: truth by quaternions, errors
// added to it.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/imu_calibration.hpp"

namespace coast::test {

struct Tumble {
  int poses = 25;
  double rate_hz = 100.0;
  double rest_s = 5.0;
  double turn_s = 3.0;
  double wobble = 0.3;         ///< rad, of the hand while it turns
  double latitude = 0.8;       ///< rad
  double gravity = 9.81;       ///< m/s^2
  double gyro_noise = 2e-4;    ///< rad/s/sqrt(Hz)
  double accel_noise = 1e-3;   ///< m/s^2/sqrt(Hz)
  double gyro_walk = 1e-5;     ///< rad/s/sqrt(s)
  double accel_wander = 2e-3;  ///< m/s^2, from rest to rest
  double earth_rate = geo::kEarthRate;
  std::uint64_t seed = 1;
};

struct Tumbled {
  record::ImuRecording sensor;
  std::vector<std::pair<double, double>> rests;              ///< s from the start
  Eigen::Vector3d mean_gyro_bias = Eigen::Vector3d::Zero();  ///< over the rests
};

/// Attitudes in a frame fixed to the Earth; turns begin and end with zero rate and acceleration.
class Handling {
 public:
  Handling(const Tumble& plan, std::mt19937_64& generator) : plan_(plan) {
    std::normal_distribution<double> normal;
    const auto draw = [&] { return Eigen::Vector3d(normal(generator), normal(generator), normal(generator)); };
    for (int j = 0; j < plan.poses; ++j) {
      poses_.push_back(
          Eigen::Quaterniond(normal(generator), normal(generator), normal(generator), normal(generator)).normalized());
      wobbles_.push_back(plan.wobble * draw());
      wander.push_back(plan.accel_wander * draw());
      if (j > 0) turns_.push_back(rotation_between(poses_[poses_.size() - 2], poses_.back()));
    }
  }
  [[nodiscard]] std::size_t pose_at(double t) const {
    return std::min(static_cast<std::size_t>(std::max(0.0, t) / period()), poses_.size() - 1);
  }
  [[nodiscard]] double into_turn(double t) const { return t - static_cast<double>(pose_at(t)) * period() - plan_.rest_s; }
  [[nodiscard]] double period() const { return plan_.rest_s + plan_.turn_s; }
  [[nodiscard]] Eigen::Quaterniond attitude(double t) const {
    const std::size_t j = pose_at(t);
    const double into = into_turn(t);
    if (into <= 0.0 || j + 1 == poses_.size()) return poses_[j];
    const double x = into / plan_.turn_s;
    const double s = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
    const double bump = 64.0 * std::pow(x * (1.0 - x), 3);
    return poses_[j] * turned(s * turns_[j]) * turned(bump * std::sin(4.0 * std::numbers::pi * into) * wobbles_[j]);
  }
  static Eigen::Vector3d rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
    const Eigen::AngleAxisd step(from.conjugate() * to);
    return step.angle() * step.axis();
  }
  std::vector<Eigen::Vector3d> wander;  ///< of the accelerometers at each pose, m/s^2

 private:
  static Eigen::Quaterniond turned(const Eigen::Vector3d& v) {
    const Eigen::Vector3d axis = v.norm() > 0.0 ? Eigen::Vector3d(v.normalized()) : Eigen::Vector3d::UnitX();
    return Eigen::Quaterniond(Eigen::AngleAxisd(v.norm(), axis));
  }
  Tumble plan_;
  std::vector<Eigen::Quaterniond> poses_;
  std::vector<Eigen::Vector3d> turns_, wobbles_;
};

inline Tumbled tumbled(const Tumble& plan, const record::TriadErrors& accel, const record::TriadErrors& gyro) {
  std::mt19937_64 generator(plan.seed);
  const Handling hand(plan, generator);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return Eigen::Vector3d(normal(generator), normal(generator), normal(generator)); };
  const double dt = 1.0 / plan.rate_hz;
  const auto samples = static_cast<std::size_t>((plan.poses * hand.period() - plan.turn_s) * plan.rate_hz);
  const Eigen::Vector3d earth_n = plan.earth_rate * Eigen::Vector3d(std::cos(plan.latitude), 0.0, -std::sin(plan.latitude));
  Tumbled made;
  made.sensor.source = "tumbled";
  made.sensor.rate_hz = plan.rate_hz;
  Eigen::Vector3d walk = Eigen::Vector3d::Zero();
  const geo::GpsTime start = geo::GpsTime::from_week(2300, 1000.0);
  double resting = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    const double t0 = static_cast<double>(i) * dt;
    Eigen::Vector3d angle = Eigen::Vector3d::Zero();
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    constexpr int kParts = 8;
    for (int p = 0; p < kParts; ++p) {
      const double a = t0 + dt * p / kParts, b = t0 + dt * (p + 1) / kParts;
      const Eigen::Quaterniond middle = hand.attitude(0.5 * (a + b));
      angle += Handling::rotation_between(hand.attitude(a), hand.attitude(b)) + middle.conjugate() * earth_n * (dt / kParts);
      force += middle.conjugate() * Eigen::Vector3d(0.0, 0.0, -plan.gravity) / kParts;
    }
    const bool rests = hand.into_turn(t0) < -0.5 * dt;
    if (!rests) force += 2.0 * Eigen::Vector3d(std::sin(9.0 * t0), std::sin(7.0 * t0), std::sin(8.0 * t0));  // the hand
    walk += plan.gyro_walk * std::sqrt(dt) * draw();
    if (rests) made.mean_gyro_bias += gyro.bias + walk, resting += 1.0;
    record::ImuSample& sample = made.sensor.samples.emplace_back();
    sample.t = start + (t0 + dt);
    sample.dt = dt;
    sample.dtheta = angle + gyro.gain * angle + (gyro.bias + walk) * dt + plan.gyro_noise * std::sqrt(dt) * draw();
    const Eigen::Vector3d& wander = hand.wander[hand.pose_at(t0)];
    sample.dv = (force + accel.gain * force + accel.bias + wander) * dt + plan.accel_noise * std::sqrt(dt) * draw();
  }
  for (int j = 0; j < plan.poses; ++j) made.rests.emplace_back(j * hand.period(), j * hand.period() + plan.rest_s);
  made.mean_gyro_bias /= resting;
  return made;
}

/// Errors of a MEMS, drawn; the gain of the accelerometers is symmetric, as estimated.
inline std::pair<record::TriadErrors, record::TriadErrors> drawn_errors(std::uint64_t seed, double gain = 0.01) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  record::TriadErrors accel, gyro;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      gyro.gain(i, j) = gain * normal(generator);
      if (j >= i) accel.gain(i, j) = accel.gain(j, i) = gain * normal(generator);
    }
    accel.bias[i] = 0.2 * normal(generator);
    gyro.bias[i] = 0.01 * normal(generator);
  }
  return {accel, gyro};
}

}  // namespace coast::test
