#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "coast/array/defect_study.hpp"

namespace coast::array {

namespace {

using SixSignals = Eigen::Matrix<double, kChannels, Eigen::Dynamic>;

/// Three sines per channel with an envelope common to the platform: part of the time it is at rest.
SixSignals common_motion(const ArraySimulation& simulation, Eigen::Index samples, std::mt19937_64& random) {
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const double two_pi = 2.0 * std::numbers::pi;
  const double period = draw(25.0, 50.0), shift = draw(0.0, two_pi);
  SixSignals motion = SixSignals::Zero(kChannels, samples);
  for (int c = 0; c < kChannels; ++c) {
    const double most = c < 3 ? 0.35 : 1.0;
    for (int i = 0; i < 3; ++i) {
      const double amplitude = draw(0.3, 1.0) * most;
      const double omega = two_pi * std::exp(draw(std::log(0.05), std::log(1.5)));
      const double phase = draw(0.0, two_pi);
      for (Eigen::Index n = 0; n < samples; ++n) {
        const double t = static_cast<double>(n) * simulation.dt;
        const double envelope = std::clamp(0.5 + 1.5 * std::sin(two_pi * t / period + shift), 0.0, 1.0);
        motion(c, n) += envelope * amplitude * std::sin(omega * t + phase);
      }
    }
  }
  motion.row(5).array() -= 9.81;
  return motion;
}

void add_errors(const ArraySimulation& simulation, SensorSignals& sensor, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto uniform = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const double a = simulation.autocorrelation;
  const double strength = std::exp(uniform(-0.5, 0.5));
  for (int c = 0; c < kChannels; ++c) {
    const double sd = strength * (c < 3 ? simulation.gyro_sd : simulation.accelerometer_sd);
    const double walk = (c < 3 ? simulation.gyro_walk : simulation.accelerometer_walk) * std::sqrt(simulation.dt);
    const double period = uniform(300.0, 900.0), phase = uniform(0.0, 2.0 * std::numbers::pi);
    double bias = normal(random) * (c < 3 ? 0.01 : 0.1);
    double x = normal(random);
    for (Eigen::Index n = 0; n < sensor.values.cols(); ++n) {
      const double t = static_cast<double>(n) * simulation.dt;
      x = a * x + std::sqrt(1.0 - a * a) * normal(random);
      bias += walk * normal(random);
      sensor.values(c, n) += bias + sd * std::exp(0.3 * std::sin(2.0 * std::numbers::pi * t / period + phase)) * x;
    }
  }
}

Eigen::Matrix3d small_errors(std::mt19937_64& random) {
  constexpr double kSd = 0.002;
  std::normal_distribution<double> normal(0.0, kSd);
  Eigen::Matrix3d M = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) M(i, j) += normal(random);
  return M;
}

}  // namespace

Signals simulate_array(const ArraySimulation& simulation, std::uint64_t seed) {
  if (simulation.sensors == 0 || !(simulation.dt > 0.0 && simulation.duration_s > 0.0))
    throw std::invalid_argument(
        fmt::format("simulate_array: {} sensors, dt {} s, {} s", simulation.sensors, simulation.dt, simulation.duration_s));
  std::mt19937_64 random(seed);
  const auto samples = static_cast<Eigen::Index>(std::floor(simulation.duration_s / simulation.dt + 0.5));
  const SixSignals motion = common_motion(simulation, samples, random);
  Signals signals;
  signals.dt = simulation.dt;
  for (std::size_t k = 0; k < simulation.sensors; ++k) {
    SensorSignals& sensor = signals.sensors.emplace_back();
    sensor.name = fmt::format("s{}", k + 1);
    sensor.usable.assign(static_cast<std::size_t>(samples), kAllUsable);
    sensor.values.resize(kChannels, samples);
    sensor.values.topRows<3>() = small_errors(random) * motion.topRows<3>();
    sensor.values.bottomRows<3>() = small_errors(random) * motion.bottomRows<3>();
    add_errors(simulation, sensor, random);
  }
  return signals;
}

void inject(Signals& signals, const Injection& injection, std::uint64_t seed) {
  if (injection.sensor >= signals.sensors.size() || injection.channel < 0 || injection.channel >= kChannels ||
      injection.from >= injection.to || injection.to > signals.samples() || injection.kind == DefectKind::kUnknown)
    throw std::invalid_argument(fmt::format("inject: {} into sensor {}, channel {}, columns {} to {}", name_of(injection.kind),
                                            injection.sensor, injection.channel, injection.from, injection.to));
  SensorSignals& sensor = signals.sensors[injection.sensor];
  const int c = injection.channel;
  const int next = c / 3 * 3 + (c + 1) % 3;
  std::mt19937_64 random(seed ^ 0x9E3779B97F4A7C15ULL);
  std::normal_distribution<double> normal;
  for (std::size_t n = injection.from; n < injection.to; ++n) {
    const auto i = static_cast<Eigen::Index>(n);
    auto& values = sensor.values;
    switch (injection.kind) {
      case DefectKind::kBiasJump:
        values(c, i) += injection.size;
        break;
      case DefectKind::kScaleChange:
        values(c, i) *= injection.size;
        break;
      case DefectKind::kStuck:
        values(c, i) = values(c, static_cast<Eigen::Index>(injection.from));
        break;
      case DefectKind::kNoiseBurst:
        values(c, i) += injection.size * normal(random);
        break;
      case DefectKind::kSwappedAxis:
        std::swap(values(c, i), values(next, i));
        break;
      default:
        if (injection.size == 0.0)
          sensor.usable[n] = 0;
        else
          values.col(i).setZero();
        break;
    }
  }
}

}  // namespace coast::array
