// Positions of one receiver against the truth of simulated observations, and what must not be believed.

#include "coast/carrier/single_point.hpp"

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace coast::carrier {
namespace {

/// Codes of one epoch without errors, in the lowest band.
std::vector<CodeMeasurement> codes_of(const SimulatedBaseline& mission, std::size_t epoch) {
  const BroadcastOrbits orbits(mission.observed.navigation);
  std::vector<CodeMeasurement> codes;
  const record::ObservationEpoch& e = mission.observed.rover.epochs[epoch];
  for (const record::Observation& o : e.observations) {
    if (o.signal.band != '1') continue;
    const auto state = at_transmission(orbits, o.satellite, e.t, *o.code_m);
    codes.push_back({o.satellite, *state, *o.code_m, 1.0, -*o.doppler_hz * 299792458.0 / 1575.42e6});
  }
  return codes;
}

class SinglePointTest : public testing::Test {
 protected:
  SimulatedBaseline mission_{"car_roundabout", 400.0, error_free()};
  std::size_t epoch_ = 200;
  geo::GpsTime t_ = mission_.observed.rover.epochs[epoch_].t;
};

TEST_F(SinglePointTest, MeetsTheTruthWithoutErrors) {
  const auto point = single_point(codes_of(mission_, epoch_), t_, Eigen::Vector3d::Zero(), {}, 0.1);
  ASSERT_TRUE(point);
  const simulate::Kinematics truth = mission_.truth(t_ - point->clock_s);
  // Codes are rounded to a millimetre, times to a nanosecond; geometry takes it a few times.
  EXPECT_LT((point->r_e - truth.r_eb_e).norm(), 3e-3);
  EXPECT_LT(std::abs(point->clock_s), 6e-4);
  EXPECT_GE(point->satellites, 8);
  EXPECT_TRUE(point->left_out.empty());
  ASSERT_TRUE(point->velocity);
  // Doppler has noise of 0.02 Hz: 4 mm/s, and geometry takes it up to twice.
  EXPECT_LT((point->velocity->v_e - truth.v_eb_e).norm(), 0.025);
  EXPECT_GT(truth.v_eb_e.norm(), 1.0);
}

TEST_F(SinglePointTest, LeavesOutTheCodeThatContradictsTheOthers) {
  std::vector<CodeMeasurement> codes = codes_of(mission_, epoch_);
  codes[3].code += 150.0;
  const auto point = single_point(codes, t_, Eigen::Vector3d::Zero(), {}, 0.1);
  ASSERT_TRUE(point);
  EXPECT_EQ(point->left_out, std::vector{codes[3].satellite});
  EXPECT_LT((point->r_e - mission_.truth(t_ - point->clock_s).r_eb_e).norm(), 5e-3);
}

TEST_F(SinglePointTest, SaysNothingWithTooFewSatellites) {
  std::vector<CodeMeasurement> codes = codes_of(mission_, epoch_);
  codes.resize(3);
  EXPECT_FALSE(single_point(codes, t_, Eigen::Vector3d::Zero(), {}, 0.1));
  EXPECT_FALSE(single_point({}, t_, Eigen::Vector3d::Zero(), {}, 0.1));
}

}  // namespace
}  // namespace coast::carrier
