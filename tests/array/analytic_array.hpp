#pragma once
// Several IMUs on a platform whose motion is known in closed form. Means over intervals by quadrature, not by anything of ours.

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "coast/array/frames.hpp"

namespace coast::test {

/// Angular rate and specific force at the body's origin: three sines each, of incommensurable frequencies.
struct PlatformMotion {
  double rate = 3.0;       ///< rad/s, amplitude
  double force = 10.0;     ///< m/s^2
  double frequency = 1.0;  ///< Hz, of the slowest; the fastest has 2.7 times as much

  [[nodiscard]] Eigen::Vector3d omega(double t) const { return sines(t, rate, 0); }
  [[nodiscard]] Eigen::Vector3d alpha(double t) const { return sines(t, rate, 1); }
  [[nodiscard]] Eigen::Vector3d f(double t) const { return sines(t + 17.0, force, 0) + Eigen::Vector3d(0, 0, -9.8); }
  [[nodiscard]] Eigen::Vector3d f_at(double t, const Eigen::Vector3d& r) const {
    return f(t) + alpha(t).cross(r) + omega(t).cross(omega(t).cross(r));
  }

 private:
  [[nodiscard]] Eigen::Vector3d sines(double t, double amplitude, int derivative) const {
    constexpr double kTurn = 2.0 * M_PI;
    const std::array factors{1.0, 1.618, 2.7};
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < factors.size(); ++i) {
        const double w = kTurn * frequency * factors[i];
        const double phase = w * t + 0.7 * axis + 1.3 * static_cast<double>(i);
        sum(axis) += amplitude / 3.0 * (derivative == 0 ? std::sin(phase) : w * std::cos(phase));
      }
    }
    return sum;
  }
};

/// Mean of g over (a, b]: Gauss-Legendre with five points.
template <class Function>
Eigen::Vector3d mean_over(double a, double b, const Function& g) {
  constexpr std::array kNodes{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array kWeights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                0.2369268850561891};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < kNodes.size(); ++i) sum += 0.5 * kWeights[i] * g(0.5 * (a + b) + 0.5 * (b - a) * kNodes[i]);
  return sum;
}

/// What each sensor measures in its own axes, free of noise.
inline array::Signals analytic_array(const PlatformMotion& motion, const std::vector<array::SensorFrame>& frames, double dt,
                                     std::size_t samples) {
  array::Signals signals;
  signals.dt = dt;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    array::SensorSignals& sensor = signals.sensors.emplace_back();
    sensor.name = fmt::format("imu{}", k + 1);
    sensor.values.resize(array::kChannels, static_cast<Eigen::Index>(samples));
    sensor.usable.assign(samples, array::kAllUsable);
    const Eigen::Matrix3d C_b_s = frames[k].C_s_b.transpose();
    for (std::size_t n = 0; n < samples; ++n) {
      const double from = static_cast<double>(n) * dt, to = from + dt;
      auto column = sensor.values.col(static_cast<Eigen::Index>(n));
      column.head<3>() = C_b_s * mean_over(from, to, [&](double t) { return motion.omega(t); });
      column.tail<3>() = C_b_s * mean_over(from, to, [&](double t) { return motion.f_at(t, frames[k].r_b); });
    }
  }
  return signals;
}

inline void add_white_noise(array::Signals& signals, double rate_sd, double force_sd, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  for (array::SensorSignals& sensor : signals.sensors)
    for (Eigen::Index n = 0; n < sensor.values.cols(); ++n)
      for (int c = 0; c < array::kChannels; ++c) sensor.values(c, n) += (c < 3 ? rate_sd : force_sd) * normal(generator);
}

/// Four sensors, turned by up to 90 degrees and up to 12 cm from the origin.
inline std::vector<array::SensorFrame> four_frames() {
  const auto turned = [](double angle, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  };
  return {{Eigen::Matrix3d::Identity(), {0.05, -0.03, 0.01}},
          {turned(M_PI / 2.0, {0, 0, 1}), {-0.12, 0.04, 0.02}},
          {turned(0.3, {1, 2, -1}), {0.02, 0.10, -0.05}},
          {turned(-1.1, {-1, 0.5, 2}), {0.05, -0.11, 0.02}}};
}

}  // namespace coast::test
