// Integers that are kept: fix and hold.

#include "fixing.hpp"

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace coast::carrier {
namespace {

using Kind = Unknown::Kind;

Unknown ambiguity(std::uint8_t number, int arc = 1) {
  return {Kind::kAmbiguity, {record::SatelliteSystem::kGps, number}, '1', arc};
}

TEST(IntegerHold, KeepsWhatComesOutThreeTimesWhateverTheReference) {
  IntegerHold hold;
  EXPECT_TRUE(hold.agreed({{ambiguity(1), ambiguity(9), 5.0}, {ambiguity(2), ambiguity(9), -3.0}}).empty());
  // The same integers against another satellite.
  EXPECT_TRUE(hold.agreed({{ambiguity(2), ambiguity(1), -8.0}, {ambiguity(9), ambiguity(1), -5.0}}).empty());
  const auto agreed = hold.agreed({{ambiguity(1), ambiguity(9), 5.0}, {ambiguity(2), ambiguity(9), -3.0}});
  ASSERT_EQ(agreed.size(), 2U);
  EXPECT_EQ(agreed[0].integer, 5.0);
  // One that changes begins anew, the other stays.
  const auto changed = hold.agreed({{ambiguity(1), ambiguity(9), 5.0}, {ambiguity(2), ambiguity(9), -4.0}});
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_EQ(changed[0].ambiguity, ambiguity(1));
  // A new arc is another ambiguity.
  EXPECT_TRUE(hold.agreed({{ambiguity(1, 2), ambiguity(9), 5.0}}).empty());
}

TEST(IntegerHold, HeldIntegersAreMeasurementsOfTheDifference) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(5);
  x(3) = 7.2;
  x(4) = 2.0;
  RelativeState state({ambiguity(1), ambiguity(9)}, x, Eigen::MatrixXd::Identity(5, 5));
  const HeldIntegers h = held({{ambiguity(1), ambiguity(9), 5.0}}, state);
  ASSERT_EQ(h.nu.size(), 1);
  // One step along H' lands on the integer.
  state.x += h.H.transpose() * h.nu / h.H.squaredNorm();
  EXPECT_NEAR(state.x(3) - state.x(4), 5.0, 1e-12);
}

// Behind the tunnel of 20 s all begins anew; with 30 s of code multipath holding must not make it worse, and never wrong.
TEST(Ppk, FixAndHoldFixesAtLeastAsMuchAndNothingWrong) {
  simulate::ObservationOptions options;
  options.base_n = {8000.0, 4000.0, 0.0};
  options.slips_per_hour = 10.0;
  const SimulatedBaseline mission("car_roundabout", 500.0, options);
  PpkOptions ppk;
  ppk.order = PassOrder::kForward;
  const Errors without = errors_of(mission, mission.solve(ppk));
  ppk.fixing.hold = true;
  const Errors with = errors_of(mission, mission.solve(ppk));
  EXPECT_GE(with.fixed, without.fixed);
  EXPECT_EQ(with.wrong, 0U);
  EXPECT_GE(with.fixed, 490U);
}

}  // namespace
}  // namespace coast::carrier
