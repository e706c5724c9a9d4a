// The transition that is composed from samples, against finite differences of the nonlinear navigator on the manifold.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coast/estimate/navigator.hpp"
#include "coast/estimate/transition.hpp"
#include "coast/geo/rotation.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;

struct Case {
  double rate_hz;
  ins::IncrementKind kind;
  double earth_rate;
};

class Dynamics : public testing::TestWithParam<Case> {
 protected:
  Dynamics()
      : C_s_b_(geo::rotation_matrix({0.3, -1.1, 2.0})),
        layout_(test::error_model(test::kFullModel), C_s_b_, {}),
        recording_(test::make_recording({.duration = 60.0, .imu_rate_hz = GetParam().rate_hz}, nullptr, 1)) {}

  // A start at the given second; sensor states of a bad consumer IMU.
  [[nodiscard]] Navigator::Start start(double at, double sensor_errors) const {
    std::mt19937_64 random(7);
    Navigator::Start s;
    s.nav = recording_.truth(test::mission_start() + at);
    s.x = sensor_errors *
          layout_.initial_covariance().diagonal().cwiseSqrt().cwiseProduct(test::normal_vector(layout_.size(), random));
    return s;
  }

  [[nodiscard]] Eigen::MatrixXd reference(const Navigator::Start& nominal) const;
  void compare(const NavRows& Phi_n, const Eigen::MatrixXd& expected, double nonlinear) const;

  /// State after a second, and on request the transition on the way.
  [[nodiscard]] record::NavState run(const Navigator::Start& s, TransitionAccumulator* transition) const {
    Navigator navigator(layout_, GetParam().kind, GetParam().earth_rate);
    navigator.set(s);
    double pending = 0.0;
    const auto first = static_cast<std::size_t>(std::lround((s.nav.t - test::mission_start()) * GetParam().rate_hz));
    for (std::size_t i = first; i < first + static_cast<std::size_t>(GetParam().rate_hz); ++i) {
      const record::ImuSample& sample = recording_.imu.samples[i];
      const SampleDynamics& dynamics = navigator.propagate({sample.dt, sample.dtheta, sample.dv});
      pending += sample.dt;
      if (transition != nullptr) transition->add(dynamics);
      if (pending < TransitionAccumulator::kSubstep) continue;
      if (transition != nullptr) transition->fold(navigator.gravity_gradient());
      navigator.advance_sensor_states();
      pending = 0.0;
    }
    if (transition != nullptr) transition->fold(navigator.gravity_gradient());
    navigator.advance_sensor_states();
    return navigator.nav();
  }

  Eigen::Matrix3d C_s_b_;
  StateLayout layout_;
  test::Recording recording_;
};

// Columns: derivatives of the navigation errors after a second to every state at its start.
Eigen::MatrixXd Dynamics::reference(const Navigator::Start& nominal) const {
  // Large enough for the rounding of a position (1e-9 m), small enough for what is of third order in them.
  Eigen::VectorXd step(layout_.size());
  step.segment<3>(kPos).setConstant(10.0);
  step.segment<3>(kVel).setConstant(1.0);
  step.segment<3>(kPsi).setConstant(1e-3);
  for (const auto& block : layout_.sensors())
    step(block.offset) = block.signal_b ? 2e-3 : (block.sensor == noise::Sensor::kGyro ? 1e-3 : 1e-1);
  const auto perturbed = [&](const Eigen::VectorXd& error) {
    Navigator::Start s = nominal;
    remove_error(-error, s.nav, s.x);
    return run(s, nullptr);
  };
  Eigen::MatrixXd columns(kNav, layout_.size());
  for (int j = 0; j < layout_.size(); ++j) {
    const Eigen::VectorXd error = step(j) * Eigen::VectorXd::Unit(layout_.size(), j);
    columns.col(j) = error_between(perturbed(error), perturbed(-error)) / (2.0 * step(j));
  }
  return columns;
}

void Dynamics::compare(const NavRows& Phi_n, const Eigen::MatrixXd& expected, double nonlinear) const {
  for (int row = 0; row < kNav; row += 3) {
    // What the second-order product of a fold leaves out: Coriolis on position w h/2 = 2e-6, tilt on position 1e-5.
    for (int col = 0; col < kNav; col += 3)
      test::expect_near_matrix(Phi_n.block(row, col, 3, 3), expected.block(row, col, 3, 3), 2e-5,
                               fmt::format("{} {}", row, col));
    for (const auto& block : layout_.sensors()) {
      // Relative to the largest of its kind: small columns are differences of large ones.
      double largest = 0.0;
      for (const auto& other : layout_.sensors())
        if (other.sensor == block.sensor && other.signal_b.has_value() == block.signal_b.has_value())
          largest = std::max(largest, expected.block(row, other.offset, 3, 1).norm());
      double phi = 1.0;
      block.process->transition(0.5 * TransitionAccumulator::kSubstep, Eigen::Map<Eigen::MatrixXd>(&phi, 1, 1));
      // Force and attitude that change within a fold (shaking at 1.5 Hz), and sensor states that the navigator holds for one.
      const double tolerance = (block.signal_b ? 2e-3 : 5e-4) + 1.2 * (1.0 - phi) + nonlinear;
      const Eigen::VectorXd difference = Phi_n.block(row, block.offset, 3, 1) - expected.block(row, block.offset, 3, 1);
      EXPECT_LE(difference.norm(), tolerance * largest) << block.name << " in row " << row;
    }
  }
}

TEST_P(Dynamics, TransitionAgreesWithFiniteDifferencesOfTheNavigator) {
  for (const double at : {3.0, 17.0, 41.0}) {
    for (const double sensor_errors : {0.0, 1.0}) {
      const Navigator::Start nominal = start(at, sensor_errors);
      TransitionAccumulator transition(layout_, GetParam().earth_rate);
      (void)run(nominal, &transition);
      ASSERT_NEAR(transition.elapsed(), 1.0, 1e-9);
      // The derivative to one sensor error at another's value: errors of 800 ppm and 0.8 mrad, up to 2.5 sd.
      compare(transition.Phi_n(), reference(nominal), sensor_errors > 0.0 ? 3e-3 : 0.0);
    }
  }
}

// Errors of compensated increments are not constant in u: only raw ones show what follows.
class RawDynamics : public Dynamics {};

TEST_P(RawDynamics, NavigatorUndoesTheErrorsOfTheSensors) {
  std::mt19937_64 random(3);
  const Navigator::Start truth = start(10.0, 0.0);
  const Eigen::VectorXd sensor_error =
      layout_.initial_covariance().diagonal().cwiseSqrt().cwiseProduct(test::normal_vector(layout_.size(), random));
  // Measured increments with constant additive and multiplicative errors, in sensor axes: straight from the definition.
  test::Recording spoiled = recording_;
  Navigator::Start nominal = truth;
  for (const auto& block : layout_.sensors()) {
    double phi = 1.0;
    block.process->transition(1.0, Eigen::Map<Eigen::MatrixXd>(&phi, 1, 1));
    if (phi != 1.0) continue;
    nominal.x(block.offset) = sensor_error(block.offset);
    for (std::size_t i = 0; i < spoiled.imu.samples.size(); ++i) {
      const record::ImuSample& s = recording_.imu.samples[i];
      const bool gyro = block.sensor == noise::Sensor::kGyro;
      const double input = block.signal_b ? block.signal_b->dot(gyro ? s.dtheta : s.dv) : s.dt;
      (gyro ? spoiled.imu.samples[i].dtheta : spoiled.imu.samples[i].dv) +=
          sensor_error(block.offset) * input * block.response_b;
    }
  }
  const record::NavState expected = run(truth, nullptr);
  std::swap(recording_, spoiled);
  const Eigen::VectorXd difference = error_between(run(nominal, nullptr), expected);
  // Rounding.
  EXPECT_LE(difference.segment<3>(kPos).norm(), 1e-8);
  EXPECT_LE(difference.segment<3>(kVel).norm(), 1e-9);
  EXPECT_LE(difference.segment<3>(kPsi).norm(), 1e-12);
}

const auto kRawCases = testing::Values(Case{100.0, ins::IncrementKind::kRaw, geo::kEarthRate},
                                       Case{200.0, ins::IncrementKind::kRaw, geo::kEarthRate},
                                       Case{200.0, ins::IncrementKind::kRaw, -geo::kEarthRate});
INSTANTIATE_TEST_SUITE_P(Rates, Dynamics, kRawCases);
INSTANTIATE_TEST_SUITE_P(Compensated, Dynamics,
                         testing::Values(Case{200.0, ins::IncrementKind::kCompensated, geo::kEarthRate}));
INSTANTIATE_TEST_SUITE_P(Rates, RawDynamics, kRawCases);

}  // namespace
}  // namespace coast
