// The covariance from knot to knot against a dense integration of the error equations along the analytic motion, in steps of
// a millisecond; and that the work per sample touches no heap.

#include <gtest/gtest.h>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/navigator.hpp"
#include "coast/estimate/transition.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/reversal.hpp"
#include "estimate/mission.hpp"
#include "support/malloc_guard.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;

constexpr double kMoving = 12.0;  // s into the motion

class Covariance : public testing::Test {
 protected:
  void prepare(const char* model) {
    layout_ =
        std::make_unique<StateLayout>(test::error_model(model), geo::rotation_matrix({0.3, -1.1, 2.0}), AuxiliaryStates{});
    recording_ = test::make_recording({.duration = 60.0}, nullptr, 1);
  }

  // Rates of one state: dx/dt = -beta x + white of density q.
  struct Rates {
    Eigen::VectorXd beta, q;
  };
  [[nodiscard]] Rates rates() const {
    Rates r{Eigen::VectorXd::Zero(layout_->size()), Eigen::VectorXd::Zero(layout_->size())};
    for (const auto& block : layout_->sensors()) {
      double phi = 1.0, Q = 0.0;
      block.process->transition(1.0, Eigen::Map<Eigen::MatrixXd>(&phi, 1, 1));
      block.process->driving_noise(1.0, Eigen::Map<Eigen::MatrixXd>(&Q, 1, 1));
      const double beta = -std::log(phi);
      r.beta(block.offset) = beta;
      r.q(block.offset) = beta > 0.0 ? Q * 2.0 * beta / -std::expm1(-2.0 * beta) : Q;
    }
    return r;
  }

  [[nodiscard]] static Eigen::Matrix3d density(const Eigen::Matrix3d& noise) { return noise * noise.transpose(); }

  [[nodiscard]] Eigen::MatrixXd brute_force(Eigen::MatrixXd P, double seconds) const {
    const auto n = layout_->size();
    const Rates r = rates();
    const double dt = 1e-3;
    const Eigen::Vector3d w(0.0, 0.0, geo::kEarthRate);
    for (int k = 0; k < std::lround(seconds / dt); ++k) {
      const simulate::Kinematics body = recording_.motion->at(kMoving + (k + 0.5) * dt);
      const Eigen::Vector3d omega = simulate::omega_ib_b(body), f = simulate::f_ib_b(body);
      geo::LocalGravity gravity;
      (void)gravity.at(body.r_eb_e);
      Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n), Q = Eigen::MatrixXd::Zero(n, n);
      F.block<3, 3>(kPos, kVel).setIdentity();
      F.block<3, 3>(kVel, kPos) = gravity.gradient();
      F.block<3, 3>(kVel, kVel) = -2.0 * geo::skew(w);
      F.block<3, 3>(kVel, kPsi) = -geo::skew(body.C_b_e * f);
      F.block<3, 3>(kPsi, kPsi) = -geo::skew(w);
      for (const auto& b : layout_->sensors()) {
        const bool gyro = b.sensor == noise::Sensor::kGyro;
        const double input = b.signal_b ? b.signal_b->dot(gyro ? omega : f) : 1.0;
        F.block<3, 1>(gyro ? kPsi : kVel, b.offset) = -input * (body.C_b_e * b.response_b);
        F(b.offset, b.offset) = -r.beta(b.offset);
        Q(b.offset, b.offset) = r.q(b.offset);
      }
      Q.block<3, 3>(kPsi, kPsi) = density(body.C_b_e * layout_->gyro_noise_b());
      Q.block<3, 3>(kVel, kVel) = density(body.C_b_e * layout_->accel_noise_b());
      const Eigen::MatrixXd F_dt = F * dt;
      const Eigen::MatrixXd Phi = Eigen::MatrixXd::Identity(n, n) + F_dt + 0.5 * F_dt * F_dt;
      P = (Phi * (P + 0.5 * dt * Q) * Phi.transpose() + 0.5 * dt * Q).eval();
    }
    return P;
  }

  [[nodiscard]] Eigen::MatrixXd composed(Eigen::MatrixXd P, double seconds, double knot_interval) const {
    Navigator navigator(*layout_, ins::IncrementKind::kRaw, geo::kEarthRate);
    navigator.set({recording_.truth(test::mission_start() + kMoving), Eigen::VectorXd::Zero(layout_->size()), {}});
    TransitionAccumulator transition(*layout_, geo::kEarthRate);
    const auto first = static_cast<std::size_t>(std::lround(kMoving * 100.0));
    double since_knot = 0.0;
    for (std::size_t i = first; i < first + static_cast<std::size_t>(std::lround(seconds * 100.0)); ++i) {
      const record::ImuSample& s = recording_.imu.samples[i];
      transition.add(navigator.propagate({s.dt, s.dtheta, s.dv}));
      since_knot += s.dt;
      const bool at_knot = since_knot > knot_interval - 1e-6;
      if (transition.substep_due() || at_knot) transition.fold(navigator.gravity_gradient());
      if (!at_knot) continue;
      transition.propagate_covariance(P, false);
      transition.reset();
      since_knot = 0.0;
    }
    return P;
  }

  // Differences against the standard deviations of the two states.
  static double worst(const Eigen::MatrixXd& P, const Eigen::MatrixXd& reference) {
    const Eigen::VectorXd inverse = reference.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
    return (inverse.asDiagonal() * (P - reference) * inverse.asDiagonal()).cwiseAbs().maxCoeff();
  }

  std::unique_ptr<StateLayout> layout_;
  test::Recording recording_;
};

TEST_F(Covariance, EqualsTheDenseIntegration) {
  prepare(test::kFullModel);
  std::mt19937_64 random(2);
  Eigen::VectorXd sd = layout_->initial_covariance().diagonal().cwiseSqrt().cwiseMax(1e-7);
  sd.head<kNav>() << 0.02, 0.02, 0.02, 0.01, 0.01, 0.01, 1e-3, 1e-3, 1e-3;
  const Eigen::MatrixXd P = sd.asDiagonal() * test::random_covariance(layout_->size(), random) * sd.asDiagonal();
  // Folds: 1e-4 of a transition; driving noise: see below, but most of the covariance is there from the start.
  EXPECT_LT(worst(composed(P, 2.0, 0.5), brute_force(P, 2.0)), 5e-3);
}

TEST_F(Covariance, WhiteNoiseAloneEqualsTheDenseIntegration) {
  prepare(R"(schema: coast.imu_error_model/1
gyro: {all: [{process: white_noise, density: 0.2, unit: deg/sqrt(h)}]}
accel: {all: [{process: white_noise, density: 80, unit: ug/sqrt(Hz)}]}
)");
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(layout_->size(), layout_->size());
  // The first fold of forty lacks the covariance of position with the tilt of the same fold: 1 / 40^2.
  EXPECT_LT(worst(composed(zero, 2.0, 2.0), brute_force(zero, 2.0)), 1e-3);
}

// At rest, without rotation: variance of the attitude is the integral of the density over time, for half a minute of noise in
// three levels. Forwards, and the same recording backwards.
TEST(NoiseLevels, AttitudeWalksAsTheyChange) {
  const noise::ImuErrorModel model = test::error_model(R"(schema: coast.imu_error_model/1
gyro: {all: [{process: white_noise, density: 0.2, unit: deg/sqrt(h)}]}
accel: {all: [{process: white_noise, density: 80, unit: ug/sqrt(Hz)}]}
)");
  test::Recording recording = test::make_recording({.duration = 40.0}, nullptr, 1);
  const geo::GpsTime begin = test::mission_start();
  recording.imu.noise = {{begin - 1.0, begin + 10.0, {4.0, 1.0, 1.0}, Eigen::Vector3d::Ones()},
                         {begin + 10.0, begin + 20.0, {0.25, 1.0, 9.0}, Eigen::Vector3d::Ones()},
                         {begin + 20.0, begin + 30.0, {1.0, 1.0, 1.0}, Eigen::Vector3d::Ones()}};
  recording.gnss.fixes.clear();
  const auto grown = [&](const record::ImuRecording& imu, geo::GpsTime from, geo::GpsTime to, double earth_rate) {
    Mission mission{imu, recording.gnss};
    mission.earth_rate = earth_rate;
    const ForwardFilter filter(mission, model, {});
    FilterState state{recording.truth(begin), Eigen::VectorXd::Zero(filter.layout().size()), {}};
    state.nav.t = from;
    state.P = Eigen::MatrixXd::Identity(filter.layout().size(), filter.layout().size()) * 1e-30;
    return filter.run_until(state, to, {}).last.P.block<3, 3>(kPsi, kPsi).trace();
  };
  const double density = std::pow(0.2 * geo::kDegree / 60.0, 2);  // rad^2/s, each axis
  const double expected = density * (10.0 * 6.0 + 10.0 * 10.25 + 5.0 * 3.0);
  EXPECT_NEAR(grown(recording.imu, begin, begin + 25.0, geo::kEarthRate) / expected, 1.0, 1e-3);  // a fold, 0.05 s of 25
  const geo::GpsTime mirror = begin + 20.0;
  ins::reverse(recording.imu, mirror);
  // From the end: 15 s without a level (the last one's), 10 s each.
  const double backward = density * (15.0 * 3.0 + 10.0 * 10.25 + 5.0 * 6.0);
  EXPECT_NEAR(grown(recording.imu, begin + 5.0, begin + 35.0, -geo::kEarthRate) / backward, 1.0, 1e-3);
}

TEST_F(Covariance, DrivingNoiseWithinAnIntervalIsOfFirstOrderInIt) {
  prepare(R"(schema: coast.imu_error_model/1
gyro: {all: [{process: gauss_markov, sigma: 10, unit: deg/h, correlation_time_s: 20},
             {process: scale_factor, sigma: 500, unit: ppm, correlation_time_s: 20}]}
accel: {all: [{process: gauss_markov, sigma: 1, unit: mg, correlation_time_s: 20}, {process: random_walk, density: 9, unit: ug/sqrt(s)}]}
)");
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(layout_->size(), layout_->size());
  const Eigen::MatrixXd reference = brute_force(zero, 2.0);
  // One interval of 2 s is beta T = 0.1 of the correlation time, and the drive turns by as much; in four intervals the
  // transitions carry the rest.
  const double coarse = worst(composed(zero, 2.0, 2.0), reference);
  const double fine = worst(composed(zero, 2.0, 0.5), reference);
  EXPECT_LT(coarse, 0.15);
  EXPECT_LT(fine, 0.03);
  EXPECT_LT(fine, 0.5 * coarse);
}

TEST_F(Covariance, WorkPerSampleTouchesNoHeap) {
  prepare(test::kFullModel);
  Navigator navigator(*layout_, ins::IncrementKind::kRaw, geo::kEarthRate);
  navigator.set({recording_.truth(test::mission_start()), Eigen::VectorXd::Zero(layout_->size()), {}});
  TransitionAccumulator transition(*layout_, geo::kEarthRate);
  const test::MallocGuard guard;
  for (const record::ImuSample& s : recording_.imu.samples) {
    transition.add(navigator.propagate({s.dt, s.dtheta, s.dv}));
    navigator.set_time(s.t);
    if (!transition.substep_due()) continue;
    transition.fold(navigator.gravity_gradient());
    navigator.advance_sensor_states();
  }
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(MallocGuard, CountsAllocations) {
  const test::MallocGuard guard;
  const Eigen::VectorXd on_the_heap = Eigen::VectorXd::Zero(100);
  const auto owned = std::make_unique<double>(on_the_heap(3));
  const long counted = guard.allocations();
  EXPECT_EQ(counted, test::MallocGuard::counts() ? 2 : 0) << *owned;
}

}  // namespace
}  // namespace coast
