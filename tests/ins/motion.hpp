#pragma once
// A rotating, accelerating body whose attitude and velocity are known in closed form, for the tests of this room.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "coast/ins/strapdown.hpp"

namespace coast::test {

/// amplitude sin(2 pi frequency t + phase) + slope t, with its derivative.
struct Wave {
  double amplitude = 0.0;
  double frequency = 0.0;
  double phase = 0.0;
  double slope = 0.0;
  [[nodiscard]] double value(double t) const { return amplitude * std::sin(angle(t)) + slope * t; }
  [[nodiscard]] double derivative(double t) const { return amplitude * 2.0 * M_PI * frequency * std::cos(angle(t)) + slope; }

 private:
  [[nodiscard]] double angle(double t) const { return 2.0 * M_PI * frequency * t + phase; }
};

/// Attitude against i by z-y-x angles and velocity against i from waves; everything else is derived from them.
struct Motion {
  Wave roll, pitch, yaw;
  std::array<Wave, 3> velocity;

  [[nodiscard]] Eigen::Quaterniond q_b_i(double t) const {
    return Eigen::AngleAxisd(yaw.value(t), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(pitch.value(t), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(roll.value(t), Eigen::Vector3d::UnitX());
  }
  [[nodiscard]] Eigen::Vector3d v_i(double t) const {
    return {velocity[0].value(t), velocity[1].value(t), velocity[2].value(t)};
  }
  [[nodiscard]] Eigen::Vector3d omega_ib_b(double t) const {
    const double sr = std::sin(roll.value(t)), cr = std::cos(roll.value(t));
    const double sp = std::sin(pitch.value(t)), cp = std::cos(pitch.value(t));
    const double dr = roll.derivative(t), dp = pitch.derivative(t), dy = yaw.derivative(t);
    return {dr - dy * sp, dp * cr + dy * cp * sr, dy * cp * cr - dp * sr};
  }
  [[nodiscard]] Eigen::Vector3d f_b(double t) const {
    return q_b_i(t).conjugate() *
           Eigen::Vector3d(velocity[0].derivative(t), velocity[1].derivative(t), velocity[2].derivative(t));
  }

  /// Raw increments by composite Gauss-Legendre quadrature (8 panels of 5 points: rounding only, for what is tested here).
  [[nodiscard]] ins::RawIncrement increment(double from, double to) const {
    static constexpr std::array<double, 5> kX{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                              0.9061798459386640};
    static constexpr std::array<double, 5> kW{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                              0.2369268850561891};
    ins::RawIncrement raw{to - from, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    const double half = (to - from) / 16.0;
    for (int panel = 0; panel < 8; ++panel) {
      for (std::size_t k = 0; k < kX.size(); ++k) {
        const double t = from + half * (2 * panel + 1 + kX[k]);
        raw.dtheta += half * kW[k] * omega_ib_b(t);
        raw.dv += half * kW[k] * f_b(t);
      }
    }
    return raw;
  }
  /// The truth that compensation must give: rotation and velocity change over the interval, seen from its start.
  [[nodiscard]] Eigen::Quaterniond rotation(double from, double to) const { return q_b_i(from).conjugate() * q_b_i(to); }
  [[nodiscard]] Eigen::Vector3d velocity_change(double from, double to) const {
    return q_b_i(from).conjugate() * (v_i(to) - v_i(from));
  }
};

/// Ski-like: several hertz in all axes, out of phase, while turning. Rates to some 4 rad/s, forces to some 40 m/s^2.
inline Motion shaking(double frequency) {
  const double scale = 5.0 / frequency;
  return {{0.08 * scale, frequency, 0.3, 0.1},
          {0.05 * scale, 1.3 * frequency, 1.1, 0.0},
          {0.06 * scale, 0.8 * frequency, 2.0, 0.4},
          {Wave{0.5, frequency, 0.2, 1.0}, Wave{0.4, 1.2 * frequency, 1.7, -0.5}, Wave{0.6, 0.9 * frequency, 0.9, 9.8}}};
}

}  // namespace coast::test
