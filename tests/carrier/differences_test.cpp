// Pairs of signals, interpolation of the base, arcs and slips.

#include "coast/carrier/differences.hpp"

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace coast::carrier {
namespace {

using record::SatelliteSystem;

/// Arc of one phase at each epoch that has it.
std::vector<std::pair<geo::GpsTime, int>> arcs_of(const std::vector<DifferenceEpoch>& epochs, record::Satellite satellite,
                                                  char band) {
  std::vector<std::pair<geo::GpsTime, int>> arcs;
  for (const DifferenceEpoch& epoch : epochs)
    for (const SatelliteDifference& s : epoch.satellites)
      for (const BandDifference& b : s.bands)
        if (s.satellite == satellite && b.band == band && b.phase) arcs.emplace_back(epoch.t, b.arc);
  return arcs;
}

TEST(Signals, PairsAreThoseOfMostCommonObservations) {
  record::ObservationRecording rover, base;
  const auto add = [](record::ObservationRecording& to, std::uint8_t number, char band, char tracking, int epochs) {
    to.epochs.resize(10);
    for (int i = 0; i < epochs; ++i) {
      record::Observation o;
      o.satellite = {SatelliteSystem::kGps, number};
      o.signal = {band, tracking};
      o.code_m = 2e7;
      o.phase_cycles = 1e8;
      to.epochs[static_cast<std::size_t>(i)].observations.push_back(o);
    }
  };
  for (const std::uint8_t number : std::array<std::uint8_t, 3>{1, 2, 3}) add(rover, number, '2', 'W', 10);
  add(rover, 1, '2', 'L', 10);  // the civil signal of the one that sends it
  for (const std::uint8_t number : std::array<std::uint8_t, 3>{1, 2, 3}) add(base, number, '2', 'W', 10);
  add(base, 1, '2', 'X', 10);
  add(rover, 1, '1', 'C', 10);
  add(base, 1, '1', 'C', 10);
  add(base, 1, '1', 'P', 10);
  add(rover, 1, '5', 'Q', 10);  // the base has none
  const SignalChoice choice = choose_signals(rover, base, {SatelliteSystem::kGps});
  ASSERT_EQ(choice.size(), 2U);
  EXPECT_EQ(choice.at({SatelliteSystem::kGps, '2'}).rover, 'W');
  EXPECT_EQ(choice.at({SatelliteSystem::kGps, '2'}).base, 'W');
  EXPECT_EQ(choice.at({SatelliteSystem::kGps, '1'}).base, 'C');
  EXPECT_TRUE(choose_signals(rover, base, {SatelliteSystem::kGalileo}).empty());
}

TEST(Differences, EndArcsWhereTheReceiverSaysSoOrBandsJumpApart) {
  simulate::ObservationOptions options;
  options.slips_per_hour = 40.0;
  const SimulatedBaseline mission("car_roundabout", 600.0, options);
  const std::vector<DifferenceEpoch> epochs = mission.differences();
  std::size_t found = 0, counted = 0;
  for (const simulate::CycleSlip& slip : mission.observed.slips) {
    const auto arcs = arcs_of(epochs, slip.satellite, slip.band);
    for (std::size_t i = 1; i < arcs.size(); ++i) {
      if (arcs[i].first != slip.t) continue;
      ++counted;
      if (arcs[i].second != arcs[i - 1].second) ++found;
    }
  }
  // One slip of whole cycles parts the bands by more than the bound unless another band slips at the same epoch.
  EXPECT_GT(counted, 100U);
  EXPECT_EQ(found, counted);
}

/// Shifts a satellite's phases from an epoch on, unseen by the receiver.
void slip(SimulatedBaseline& mission, std::size_t epoch, record::Satellite satellite, const std::map<char, double>& cycles) {
  for (std::size_t i = epoch; i < mission.observed.rover.epochs.size(); ++i)
    for (record::Observation& o : mission.observed.rover.epochs[i].observations)
      if (o.satellite == satellite && o.phase_cycles && cycles.contains(o.signal.band))
        *o.phase_cycles += cycles.at(o.signal.band);
}

/// Epochs at which a phase begins a new arc, the first apart.
std::vector<std::size_t> breaks_of(const SimulatedBaseline& mission, record::Satellite satellite, char band) {
  const auto arcs = arcs_of(mission.differences(), satellite, band);
  std::vector<std::size_t> breaks;
  for (std::size_t i = 1; i < arcs.size(); ++i)
    if (arcs[i].second != arcs[i - 1].second) breaks.push_back(i);
  return breaks;
}

/// A GPS satellite that has the bands 1 and 2 throughout.
record::Satellite highest_of(const SimulatedBaseline& mission) {
  const std::vector<DifferenceEpoch> epochs = mission.differences();
  const SatelliteDifference* highest = nullptr;
  for (const SatelliteDifference& s : epochs.back().satellites)
    if (s.satellite.system == SatelliteSystem::kGps && (highest == nullptr || s.base_elevation > highest->base_elevation))
      highest = &s;
  return highest->satellite;
}

// 9 cycles of L1 with 7 of L2 move the geometry-free combination by 3 mm, the wide lane by two cycles.
TEST(Differences, MelbourneWuebbenaSeesWhatTheGeometryFreeCombinationDoesNot) {
  simulate::ObservationOptions options;
  options.code_sd = options.code_multipath_sd = 0.1;  // two wide lanes are more than four sigma
  SimulatedBaseline mission("car_roundabout", 360.0, options);
  const record::Satellite satellite = highest_of(mission);
  slip(mission, 150, satellite, {{'1', 9.0}, {'2', 7.0}});
  for (record::ObservationEpoch& epoch : mission.observed.rover.epochs)
    for (record::Observation& o : epoch.observations) {
      o.doppler_hz.reset();
      if (o.signal.band == '5') o.phase_cycles.reset();
    }
  for (const char band : {'1', '2'}) EXPECT_EQ(breaks_of(mission, satellite, band), std::vector<std::size_t>{150}) << band;
}

TEST(Differences, DopplerSeesSlipsOfSingleBands) {
  SimulatedBaseline mission("car_roundabout", 360.0, simulate::ObservationOptions{});
  const record::Satellite satellite = highest_of(mission);
  for (record::ObservationRecording* receiver : {&mission.observed.rover, &mission.observed.base})
    for (record::ObservationEpoch& epoch : receiver->epochs)
      std::erase_if(epoch.observations, [](const record::Observation& o) { return o.signal.band != '1'; });
  ASSERT_TRUE(breaks_of(mission, satellite, '1').empty());
  slip(mission, 200, satellite, {{'1', -5.0}});
  EXPECT_EQ(breaks_of(mission, satellite, '1'), std::vector<std::size_t>{200});
}

TEST(Differences, EndAnArcWhereLockIsLostBesideAMissingPhase) {
  SimulatedBaseline mission("car_roundabout", 360.0, error_free());
  record::Observation* lost = nullptr;
  for (record::Observation& o : mission.observed.rover.epochs[100].observations)
    if (lost == nullptr && o.signal.band == '1') lost = &o;
  ASSERT_NE(lost, nullptr);
  lost->lost_lock = true;
  lost->phase_cycles.reset();
  const auto arcs = arcs_of(mission.differences(), lost->satellite, '1');
  ASSERT_EQ(arcs.size(), 359U);
  EXPECT_EQ(arcs[99].second, arcs[0].second);
  EXPECT_NE(arcs[100].second, arcs[99].second);
}

TEST(Differences, KeepOneArcWhereNothingSlips) {
  const SimulatedBaseline mission("car_roundabout", 600.0, simulate::ObservationOptions{});
  const std::vector<DifferenceEpoch> epochs = mission.differences();
  std::map<std::pair<record::Satellite, char>, std::set<int>> arcs;
  for (const DifferenceEpoch& epoch : epochs)
    for (const SatelliteDifference& s : epoch.satellites)
      for (const BandDifference& b : s.bands)
        if (s.base_elevation > 20.0 * geo::kDegree) arcs[{s.satellite, b.band}].insert(b.arc);
  EXPECT_GT(arcs.size(), 20U);
  for (const auto& [signal, numbers] : arcs) EXPECT_EQ(numbers.size(), 1U) << to_string(signal.first) << signal.second;
}

TEST(Differences, OfABaseAtThirtySecondsAreThoseOfOneAtASecond) {
  simulate::ObservationOptions options = error_free();
  const SimulatedBaseline often("car_roundabout", 400.0, options);
  options.base_rate_hz = 1.0 / 30.0;
  const SimulatedBaseline seldom("car_roundabout", 400.0, options);
  const auto a = often.differences(), b = seldom.differences();
  ASSERT_EQ(a.size(), b.size());
  double largest = 0.0;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!b[i].age_s) continue;
    std::map<record::Satellite, double> first;
    std::optional<double> clock;
    for (const SatelliteDifference& s : a[i].satellites) first[s.satellite] = *s.bands[0].code;
    for (const SatelliteDifference& s : b[i].satellites) {
      if (!first.contains(s.satellite)) continue;
      const double difference = *s.bands[0].code - first.at(s.satellite);
      if (!clock) clock = difference;  // the base's clock is not interpolated well, and is the same for all
      largest = std::max(largest, std::abs(difference - *clock));
      ++compared;
    }
  }
  EXPECT_GT(compared, 3000U);
  EXPECT_LT(largest, 5e-3);  // codes are rounded to a millimetre, four of them
}

}  // namespace
}  // namespace coast::carrier
