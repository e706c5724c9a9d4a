// Integers of whole arcs from the epochs in which they were fixed.

#include "known_integers.hpp"

#include <gtest/gtest.h>

namespace coast::carrier {
namespace {

using Kind = Unknown::Kind;

record::Satellite gps(std::uint8_t number) {
  return {record::SatelliteSystem::kGps, number};
}

Unknown arc_of(std::uint8_t number, int arc) {
  return {Kind::kAmbiguity, gps(number), '1', arc};
}

/// Phases of these satellites on one band, each in an arc.
DifferenceEpoch epoch_of(const std::vector<std::pair<std::uint8_t, int>>& satellites) {
  DifferenceEpoch epoch;
  for (const auto& [number, arc] : satellites) {
    SatelliteDifference& s = epoch.satellites.emplace_back();
    s.satellite = gps(number);
    BandDifference& band = s.bands.emplace_back();
    band.phase = 0.0;
    band.arc = arc;
  }
  return epoch;
}

AmbiguityHistory history_of(std::size_t epochs) {
  return {std::vector<std::vector<FixedPair>>(epochs), std::vector<std::vector<Unknown>>(epochs)};
}

TEST(KnownIntegers, AreTheMajorityWhateverTheReference) {
  AmbiguityHistory forward = history_of(20), backward = history_of(20);
  for (std::size_t i = 0; i < 20; ++i) {
    // 1 less 9 is 5, 2 less 9 is -3; first against 9, later against 1.
    if (i < 10)
      forward.fixed[i] = {{arc_of(1, 1), arc_of(9, 1), 5.0}, {arc_of(2, 1), arc_of(9, 1), -3.0}};
    else
      forward.fixed[i] = {{arc_of(9, 1), arc_of(1, 1), -5.0}, {arc_of(2, 1), arc_of(1, 1), -8.0}};
  }
  backward.fixed[3] = {{arc_of(2, 1), arc_of(9, 1), 40.0}};  // one of eleven is wrong
  const KnownIntegers known(forward, backward);
  const std::vector<FixedPair> pairs = known.of(epoch_of({{2, 1}, {9, 1}, {7, 1}, {1, 2}}));
  ASSERT_EQ(pairs.size(), 1U);  // 7 was never fixed, and the arc of 1 is another
  EXPECT_EQ(pairs[0].integer * (pairs[0].ambiguity == arc_of(2, 1) ? 1.0 : -1.0), -3.0);
  EXPECT_EQ(known.of(epoch_of({{1, 1}, {2, 1}, {9, 1}})).size(), 2U);
}

TEST(KnownIntegers, AreNotKnownFromFewEpochsNorWhereTheyDisagree) {
  AmbiguityHistory forward = history_of(20), backward = history_of(20);
  for (std::size_t i = 0; i < 4; ++i) forward.fixed[i] = {{arc_of(1, 1), arc_of(9, 1), 5.0}};
  for (std::size_t i = 0; i < 20; ++i) backward.fixed[i] = {{arc_of(2, 1), arc_of(9, 1), i < 6 ? 1.0 : 2.0}};
  const KnownIntegers known(forward, backward);
  EXPECT_TRUE(known.of(epoch_of({{1, 1}, {2, 1}, {9, 1}})).empty());
}

// A slip between the third and the fourth epoch that neither the receiver nor the differences of bands show.
TEST(KnownIntegers, ArcsEndWhereEitherPassBeganAnew) {
  for (const bool in_forward : {true, false}) {
    std::vector<DifferenceEpoch> epochs(6, epoch_of({{1, 7}, {9, 3}}));
    AmbiguityHistory forward = history_of(6), backward = history_of(6);
    if (in_forward)
      forward.restarted[3] = {arc_of(1, 7)};
    else
      backward.restarted[2] = {arc_of(1, 7)};
    for (std::size_t i = 0; i < 6; ++i) forward.fixed[i] = {{arc_of(1, 7), arc_of(9, 3), i < 3 ? 5.0 : 6.0}};
    split_arcs(epochs, forward, backward);
    std::set<int> of_1, of_9;
    for (std::size_t i = 0; i < 6; ++i) {
      of_1.insert(epochs[i].satellites[0].bands[0].arc);
      of_9.insert(epochs[i].satellites[1].bands[0].arc);
      EXPECT_EQ(forward.fixed[i][0].ambiguity.arc, epochs[i].satellites[0].bands[0].arc);
      EXPECT_EQ(forward.fixed[i][0].reference.arc, epochs[i].satellites[1].bands[0].arc);
    }
    EXPECT_EQ(of_1.size(), 2U);
    EXPECT_EQ(of_9.size(), 1U);
    EXPECT_EQ(epochs[2].satellites[0].bands[0].arc, epochs[0].satellites[0].bands[0].arc);
    EXPECT_NE(epochs[3].satellites[0].bands[0].arc, epochs[2].satellites[0].bands[0].arc);
  }
}

}  // namespace
}  // namespace coast::carrier
