// The strapdown of room ins on error-free recordings of every motion: position, velocity and attitude against the truth.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "coast/geo/units.hpp"
#include "coast/ins/compensation.hpp"
#include "coast/ins/strapdown.hpp"
#include "coast/simulate/imu.hpp"
#include "coast/simulate/motions.hpp"

namespace coast::simulate {
namespace {

using geo::kDegree;

struct Errors {
  double position = 0.0;  // m, largest over the mission
  double velocity = 0.0;  // m/s
  double attitude = 0.0;  // rad
};

void compensate_two_sample(record::ImuRecording& imu) {
  ins::RawIncrement previous;
  for (record::ImuSample& sample : imu.samples) {
    const ins::RawIncrement current{sample.dt, sample.dtheta, sample.dv};
    const ins::BodyIncrement exact = ins::compensate_two_sample(previous, current);
    sample.dtheta = exact.phi;
    sample.dv = exact.u;
    previous = current;
  }
}

using Compensation = void (*)(record::ImuRecording&);

Errors drift(const AnalyticTrajectory& motion, double rate_hz, Compensation compensate = ins::compensate_chebyshev) {
  const geo::GpsTime start = geo::GpsTime::from_week(2374, 208800.0);
  record::ImuRecording imu = true_increments(motion, {start, rate_hz, 5}, {}, 2);
  const record::Trajectory truth = true_states(motion, imu, start, 2);
  compensate(imu);
  ins::Strapdown strapdown(truth.states.front());
  Errors worst;
  for (std::size_t k = 0; k < imu.samples.size(); ++k) {
    const record::ImuSample& sample = imu.samples[k];
    strapdown.step({sample.dt, sample.dtheta, sample.dv});
    const record::NavState& is = strapdown.state();
    const record::NavState& should = truth.states[k + 1];
    worst.position = std::max(worst.position, (is.r_eb_e - should.r_eb_e).norm());
    worst.velocity = std::max(worst.velocity, (is.v_eb_e - should.v_eb_e).norm());
    worst.attitude = std::max(worst.attitude, is.q_b_e.angularDistance(should.q_b_e));
  }
  return worst;
}

MotionParameters ten_minutes() {
  MotionParameters parameters;
  parameters.origin = {46.52 * kDegree, 6.57 * kDegree, 400.0};
  parameters.duration = 600.0;
  parameters.course = 0.5;
  return parameters;
}

class StrapdownOn : public ::testing::TestWithParam<MotionKind> {};

// The bound that the package promises for 600 s at 100 Hz.
TEST_P(StrapdownOn, ReproducesTheTruth) {
  const Errors errors = drift(make_motion(GetParam().name, ten_minutes()), 100.0);
  EXPECT_LT(errors.position, 0.01);
  EXPECT_LT(errors.velocity, 0.001);
  EXPECT_LT(errors.attitude, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Simulate, StrapdownOn, ::testing::ValuesIn(motions()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(StrapdownOnBoat, TwoSampleErrorFallsWithItsOrder) {
  MotionParameters parameters = ten_minutes();
  parameters.duration = 300.0;
  const AnalyticTrajectory motion = make_motion("boat", parameters);
  const Errors coarse = drift(motion, 25.0, compensate_two_sample);
  const Errors fine = drift(motion, 50.0, compensate_two_sample);
  const Errors finer = drift(motion, 100.0, compensate_two_sample);
  // Rate and force linear in time leave out terms of their second derivatives: h^4 a step, h^3 over a time.
  EXPECT_NEAR(std::log2(coarse.attitude / fine.attitude), 3.0, 0.2);
  EXPECT_NEAR(std::log2(fine.attitude / finer.attitude), 3.0, 0.2);
  EXPECT_NEAR(std::log2(coarse.position / fine.position), 3.0, 0.2);
  EXPECT_NEAR(std::log2(fine.position / finer.position), 3.0, 0.2);
}

}  // namespace
}  // namespace coast::simulate
