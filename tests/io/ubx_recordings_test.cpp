// A recording of an F9P: what coast reads from UBX against the RINEX file that another converter made of it, number by number.

#include <gtest/gtest.h>

#include <tuple>

#include "coast/io/rinex.hpp"
#include "support/support.hpp"

namespace coast::io {
namespace {

using record::Observation;

class UbxRecording : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: no recordings here";
  }
  static std::filesystem::path file(const char* name) { return *test::data_dir() / "raw-ubx-f9p" / name; }
};

/// The observation of the same band: the converter writes X for the tracking of each signal but L1 C/A.
const Observation* same_band(const record::ObservationEpoch& epoch, const Observation& o) {
  for (const Observation& other : epoch.observations)
    if (other.satellite == o.satellite && other.signal.band == o.signal.band) return &other;
  return nullptr;
}

TEST_F(UbxRecording, HasTheObservationsOfItsRinexFile) {
  const auto ubx = read_observations(file("f9p_static.ubx.gz"));
  const auto rinex = read_observations(file("f9p_static.obs.gz"));
  ASSERT_EQ(ubx.epochs.size(), 931U);
  ASSERT_EQ(rinex.epochs.size(), 931U);
  constexpr double kDigits = 0.5001e-3;  // three decimals; a code near 3e7 m is itself known to 4e-9
  long observations = 0, slips = 0, slips_here_only = 0, half_cycles = 0;
  for (std::size_t i = 0; i < ubx.epochs.size(); ++i) {
    const auto& epoch = ubx.epochs[i];
    ASSERT_NEAR(epoch.t - rinex.epochs[i].t, 0.0, 1e-7);
    ASSERT_EQ(epoch.observations.size(), rinex.epochs[i].observations.size());
    for (const Observation& o : epoch.observations) {
      const Observation* other = same_band(rinex.epochs[i], o);
      ASSERT_NE(other, nullptr);
      ++observations;
      const auto compare = [&](const std::optional<double>& a, const std::optional<double>& b, double tolerance) {
        ASSERT_EQ(a.has_value(), b.has_value());
        if (a) {
          ASSERT_NEAR(*a, *b, tolerance) << record::to_string(o.satellite) << " " << geo::to_string(epoch.t);
        }
      };
      compare(o.code_m, other->code_m, kDigits);
      compare(o.phase_cycles, other->phase_cycles, kDigits);
      compare(o.doppler_hz, other->doppler_hz, kDigits);
      compare(o.cn0_dbhz, other->cn0_dbhz, 0.0);
      EXPECT_EQ(o.half_cycle, other->half_cycle);
      half_cycles += o.half_cycle ? 1 : 0;
      slips += o.lost_lock ? 1 : 0;
      if (o.lost_lock != other->lost_lock) {
        // The converter flags a time of lock that has become shorter. G09 is seen three times with a time of lock that is
        // longer than the one before, 120 and then 520 ms, but shorter than the second between them.
        EXPECT_TRUE(o.lost_lock) << geo::to_string(epoch.t);
        EXPECT_EQ(record::to_string(o.satellite), "G09");
        ++slips_here_only;
      }
    }
  }
  EXPECT_EQ(observations, 7408 + 7231 + 7076 + 6954);
  EXPECT_EQ(slips, 61);
  EXPECT_EQ(slips_here_only, 3);
  EXPECT_EQ(half_cycles, 39);
}

TEST_F(UbxRecording, HasEphemeridesOfGpsAndGalileo) {
  const auto navigation = read_navigation(file("f9p_static.ubx.gz"));
  constexpr int kFnavSources = 1 << 1 | 1 << 8;
  long gps = 0, inav = 0, fnav = 0, both = 0;
  for (const auto& e : navigation.kepler) {
    const bool is_gps = e.satellite.system == record::SatelliteSystem::kGps;
    (is_gps ? gps : e.sources == kFnavSources ? fnav : inav) += 1;
    EXPECT_EQ(e.health, 0);
    EXPECT_LE(e.accuracy_m, 2.0);
  }
  EXPECT_EQ(gps, 19);
  EXPECT_EQ(inav, 28);
  EXPECT_EQ(fnav, 26);
  // Both messages of Galileo have the orbit of the same batch, in other places of other pages; F/NAV has a clock of its own.
  for (const auto& e : navigation.kepler)
    for (const auto& other : navigation.kepler) {
      if (e.sources != kFnavSources || other.sources == kFnavSources || other.satellite != e.satellite ||
          other.issue != e.issue)
        continue;
      ++both;
      EXPECT_EQ(std::tuple(e.toe, e.toc, e.sqrt_a, e.eccentricity, e.mean_anomaly, e.delta_n, e.perigee, e.node, e.node_rate),
                std::tuple(other.toe, other.toc, other.sqrt_a, other.eccentricity, other.mean_anomaly, other.delta_n,
                           other.perigee, other.node, other.node_rate));
      EXPECT_EQ(std::tuple(e.inclination, e.inclination_rate, e.cuc, e.cus, e.crc, e.crs, e.cic, e.cis, e.group_delay[0]),
                std::tuple(other.inclination, other.inclination_rate, other.cuc, other.cus, other.crc, other.crs, other.cic,
                           other.cis, other.group_delay[0]));
      EXPECT_NEAR(e.clock[0], other.clock[0], 1e-8);
    }
  EXPECT_EQ(both, 26);
  EXPECT_TRUE(navigation.gps_ionosphere);
  // Of 1251 subframes of LNAV two have a hand-over word that does not end with two zeros, and so a wrong parity after it.
  long spoiled = 0;
  for (const auto& event : navigation.events) spoiled += event.kind == "navigation_spoiled" ? event.count : 0;
  EXPECT_EQ(spoiled, 2);
}

}  // namespace
}  // namespace coast::io
