// Real RINEX files, read as they were published. Expected figures: their descriptions, and their own texts.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "coast/io/rinex.hpp"
#include "support/support.hpp"

namespace coast::io {
namespace {

namespace fs = std::filesystem;
using record::Observation;
using record::Satellite;
using record::SatelliteSystem;

class RinexRecordings : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: no recordings here";
  }
  static record::ObservationRecording observations(const std::string& name) {
    return read_observations(*test::data_dir() / name);
  }
  static record::NavigationRecording navigation(const std::string& name) { return read_navigation(*test::data_dir() / name); }
  static std::size_t satellites(const record::ObservationEpoch& epoch) {
    std::set<Satellite> all;
    for (const Observation& o : epoch.observations) all.insert(o.satellite);
    return all.size();
  }
};

TEST_F(RinexRecordings, StaticBaselineOfGeonet) {
  for (const char* name : {"rinex-gsi-2005-092/07590920.05o", "rinex-gsi-2005-092/30400920.05o"}) {
    const auto recording = observations(name);
    ASSERT_EQ(recording.epochs.size(), 120U) << name;
    EXPECT_EQ(recording.antenna, "TRM29659.00");
    for (const auto& epoch : recording.epochs) {
      EXPECT_GE(satellites(epoch), 7U);
      EXPECT_LE(satellites(epoch), 10U);
    }
    for (const auto& event : recording.events) EXPECT_EQ(event.kind, "rinex_event");  // files were spliced
  }
  EXPECT_GT(navigation("rinex-gsi-2005-092/30400920.05n").kepler.size(), 5U);
}

TEST_F(RinexRecordings, MovingCarAndItsBase) {
  const auto rover = observations("rinex-kinematic-2021-265/SEPT265G.21O.gz");
  const auto base = observations("rinex-kinematic-2021-265/3034265G.21O.gz");
  ASSERT_EQ(rover.epochs.size(), 360U);
  ASSERT_EQ(base.epochs.size(), 360U);
  EXPECT_EQ(rover.epochs.back().t, geo::GpsTime::from_calendar({2021, 9, 22, 6, 35, 59.0}));
  EXPECT_EQ(satellites(rover.epochs.front()), 19U);
  EXPECT_EQ(rover.antenna, "JAVRINGANT_DM   JVDM");
  const auto messages = navigation("rinex-kinematic-2021-265/SEPT2650.21P.gz");
  std::map<SatelliteSystem, int> count;
  for (const auto& e : messages.kepler) ++count[e.satellite.system];
  for (const auto system : {SatelliteSystem::kGps, SatelliteSystem::kGalileo, SatelliteSystem::kQzss})
    EXPECT_GT(count[system], 3);
  EXPECT_EQ(messages.gps_ionosphere->beta[2], -1.3107e5);
}

// Code and phase of one signal move together, but for noise, multipath and the ionosphere of 30 s: a number that the
// decompression spoils would stand out by far.
TEST_F(RinexRecordings, StationDayInCompactForm) {
  const auto recording = observations("rinex-esbc-2020-177/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz");
  ASSERT_EQ(recording.epochs.size(), 2880U);
  EXPECT_EQ(satellites(recording.epochs.front()), 43U);
  EXPECT_GT(recording.epochs.front().observations.size(), 100U);
  const auto& first = recording.epochs.front().observations;
  const auto c05 = std::ranges::find_if(first, [](const Observation& o) {
    return o.satellite == Satellite{SatelliteSystem::kBeidou, 5} && o.signal == record::Signal{'2', 'I'};
  });
  ASSERT_NE(c05, first.end());
  EXPECT_EQ(c05->code_m, 40715949.461);
  EXPECT_EQ(c05->phase_cycles, 212018673.071);
  EXPECT_EQ(recording.glonass_channels.at(10), -7);
  constexpr double kWavelength = 299792458.0 / 1575.42e6;  // L1 of GPS, m
  std::map<Satellite, std::pair<geo::GpsTime, double>> before;
  long steps = 0, jumps = 0;
  for (const auto& epoch : recording.epochs)
    for (const Observation& o : epoch.observations) {
      if (o.satellite.system != SatelliteSystem::kGps || o.signal != record::Signal{'1', 'C'}) continue;
      if (!o.code_m || !o.phase_cycles) continue;
      const double difference = *o.code_m - kWavelength * *o.phase_cycles;
      if (const auto last = before.find(o.satellite);
          last != before.end() && epoch.t - last->second.first < 31.0 && !o.lost_lock) {
        ++steps;
        if (std::abs(difference - last->second.second) > 15.0) ++jumps;
      }
      before[o.satellite] = {epoch.t, difference};
    }
  EXPECT_GT(steps, 25000);
  EXPECT_LE(jumps, steps / 1000);
  const auto messages = navigation("rinex-esbc-2020-177/ESBC00DNK_R_20201770000_01D_MN.rnx.gz");
  EXPECT_EQ(std::ranges::count_if(messages.kepler, [](const auto& e) { return e.satellite.system == SatelliteSystem::kGps; }),
            257);
  EXPECT_GT(messages.tabulated.size(), 100U);
}

TEST_F(RinexRecordings, BroadcastOfADay) {
  const auto messages = navigation("orbits-2010-182/brdc1820.10n.gz");
  EXPECT_EQ(messages.kepler.size(), 421U);
  std::set<Satellite> all;
  for (const auto& e : messages.kepler) all.insert(e.satellite);
  EXPECT_EQ(all.size(), 32U);
}

TEST_F(RinexRecordings, SignalSimulator) {
  for (const char* name :
       {"Base-static_MO_Spirent.obs.gz", "Rover-static-2km-east_MO_Spirent.obs.gz", "Rover-dynamic_MO_Spirent.obs.gz"}) {
    const auto recording = observations(std::string("spirent-rtk-none/") + name);
    EXPECT_GE(recording.epochs.size(), 599U) << name;
    EXPECT_EQ(recording.epochs.front().t, geo::GpsTime::from_calendar({2023, 1, 8, 10, 0, 0.0}));
  }
  EXPECT_EQ(navigation("spirent-rtk-none/RINEX_EN_Spirent.23L").kepler.front().accuracy_m, 25.0);
  EXPECT_FALSE(navigation("spirent-rtk-none/RINEX_GN_Spirent.23N").kepler.empty());
}

}  // namespace
}  // namespace coast::io
