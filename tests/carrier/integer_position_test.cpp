// The position by the integers of one epoch, against the truth of a simulation and a dense least-squares solution.

#include "integer_position.hpp"

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace coast::carrier {
namespace {

/// One epoch of a car after half a minute: float, fixed, and what the phases say.
struct FixedEpoch {
  SimulatedBaseline mission;
  std::vector<DifferenceEpoch> epochs;
  PpkOptions options;
  RelativeFilter filter;
  FloatEpoch updated;
  FixedSolution fixed;

  explicit FixedEpoch(const simulate::ObservationOptions& simulated)
      : mission("car_roundabout", 360.0, simulated), epochs(mission.differences()), options(settled()), filter(options, 1.0) {
    AmbiguityFixing fixing(options.fixing);
    constexpr std::size_t kAt = 30;
    for (std::size_t i = 0; i <= kAt; ++i) {
      updated = filter.step(epochs[i]);
      fixed = fixing.fix(epochs[i], updated, filter.state());
    }
  }
  static PpkOptions settled() {
    PpkOptions options;
    options.air = AirStates{};
    options.noise = NoiseScale{};
    return options;
  }
  [[nodiscard]] const DifferenceEpoch& epoch() const { return epochs[30]; }
  [[nodiscard]] std::optional<IntegerPosition> position() const {
    return integer_position(epoch(), updated, filter.state(), fixed);
  }
  /// Error of the position, m.
  [[nodiscard]] double error(const IntegerPosition& position) const {
    const Eigen::Vector3d r_e = (filter.state().x - updated.step + position.step).head<3>();
    const simulate::Kinematics truth = mission.truth(epoch().t - epoch().alone->clock_s);
    return (r_e - truth.r_eb_e).norm();
  }
};

TEST(IntegerPosition, MeetsTheTruthWithoutErrors) {
  const FixedEpoch at(error_free());
  ASSERT_TRUE(at.fixed.fixed);
  const std::optional<IntegerPosition> position = at.position();
  ASSERT_TRUE(position);
  EXPECT_TRUE(position->contradicted.empty());
  EXPECT_GT(position->pdop, 0.5);
  EXPECT_LT(position->pdop, 10.0);
  EXPECT_LT(at.error(*position), 0.003);  // the clock of codes moves a car by its speed times microseconds
}

TEST(IntegerPosition, LeavesOutAnIntegerThatTheOthersContradict) {
  FixedEpoch at(error_free());
  ASSERT_TRUE(at.fixed.fixed);
  const FixedPair wrong = at.fixed.pairs.front();
  at.fixed.pairs.front().integer += 1.0;
  const std::optional<IntegerPosition> position = at.position();
  ASSERT_TRUE(position);
  ASSERT_EQ(position->contradicted.size(), 1U);
  EXPECT_EQ(position->contradicted.front(), wrong.ambiguity);
  EXPECT_LT(at.error(*position), 0.003);
}

// The covariance of the conditional solution contains earlier epochs too, so it is the smaller one; both are of one size.
TEST(IntegerPosition, IsNearlyAsPreciseAsTheFilter) {
  simulate::ObservationOptions options;
  const FixedEpoch at(options);
  ASSERT_TRUE(at.fixed.fixed);
  const std::optional<IntegerPosition> position = at.position();
  ASSERT_TRUE(position);
  const double alone = position->covariance_e.trace(), conditional = at.fixed.P.topLeftCorner<3, 3>().trace();
  EXPECT_GE(alone, 0.99 * conditional);
  EXPECT_LT(alone, 4.0 * conditional);
}

}  // namespace
}  // namespace coast::carrier
