// A base that is slower than the rover, that pauses, or that ends earlier.

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace coast::carrier {
namespace {

/// Rover at 1 Hz for six minutes; of the base only the epochs for which `keep` holds, by their time since the start.
template <class Keep>
SimulatedBaseline mission_with_base(const Keep& keep) {
  simulate::ObservationOptions options;
  options.slips_per_hour = 0.0;
  SimulatedBaseline mission("car_roundabout", 360.0, options);
  std::erase_if(mission.observed.base.epochs, [&](const record::ObservationEpoch& e) { return !keep(e.t - mission.start); });
  return mission;
}

/// Arc of a phase in each epoch; -1: no phase.
int arc_at(const DifferenceEpoch& epoch, record::Satellite satellite, char band) {
  for (const SatelliteDifference& s : epoch.satellites)
    for (const BandDifference& b : s.bands)
      if (s.satellite == satellite && b.band == band && b.phase) return b.arc;
  return -1;
}

const auto kPause = [](double t) { return t < 150.0 || t > 195.0; };

TEST(BaseResiduals, PhasesGoOnBehindAPauseOfTheBase) {
  const std::vector<DifferenceEpoch> whole = mission_with_base([](double) { return true; }).differences();
  const std::vector<DifferenceEpoch> paused = mission_with_base(kPause).differences();
  std::size_t phases = 0;
  for (const SatelliteDifference& s : whole[140].satellites)
    for (const BandDifference& b : s.bands) {
      const auto goes_on = [&](const std::vector<DifferenceEpoch>& epochs, std::size_t to) {
        return arc_at(epochs[140], s.satellite, b.band) == arc_at(epochs[to], s.satellite, b.band);
      };
      if (!b.phase || !goes_on(whole, 170) || !goes_on(whole, 205)) continue;
      ++phases;
      EXPECT_TRUE(goes_on(paused, 170)) << to_string(s.satellite) << b.band;
      EXPECT_TRUE(goes_on(paused, 205)) << to_string(s.satellite) << b.band;
    }
  EXPECT_GT(phases, 12U);
}

TEST(BaseResiduals, ASlipWithinThePauseIsSeen) {
  SimulatedBaseline mission = mission_with_base(kPause);
  const std::vector<DifferenceEpoch> before = mission.differences();
  const record::Satellite slipped = before[140].satellites[1].satellite;
  const char band = before[140].satellites[1].bands[0].band;
  for (record::ObservationEpoch& e : mission.observed.base.epochs)
    for (record::Observation& o : e.observations)
      if (e.t - mission.start > 190.0 && o.satellite == slipped && o.signal.band == band && o.phase_cycles)
        *o.phase_cycles += 1.0;
  const std::vector<DifferenceEpoch> epochs = mission.differences();
  EXPECT_NE(arc_at(epochs[205], slipped, band), arc_at(epochs[140], slipped, band));
  EXPECT_EQ(arc_at(epochs[170], slipped, band), -1);  // nothing to interpolate
  const SatelliteDifference& other = epochs[140].satellites[0];
  EXPECT_EQ(arc_at(epochs[205], other.satellite, other.bands[0].band), other.bands[0].arc);
}

// Every 30 s, and the last of them 30 s before the rover's end.
TEST(BaseResiduals, ASlowBaseServesTheRoverToItsEnd) {
  const auto slow = [](double t) { return std::abs(std::remainder(t, 30.0)) < 0.01 && t < 331.0; };
  const SimulatedBaseline mission = mission_with_base(slow);
  const PpkSolution solution = mission.solve({});
  for (const PpkEpoch& epoch : solution.epochs) EXPECT_LE(epoch.age_s, 30.1) << to_string(epoch.t);
  const Errors e = errors_of(mission, solution);
  EXPECT_EQ(e.fixed, solution.epochs.size());
  EXPECT_EQ(e.wrong, 0U);
}

}  // namespace
}  // namespace coast::carrier
