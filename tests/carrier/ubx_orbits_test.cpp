// Ephemerides that a receiver decoded from the signals of a simulator, against each other and against the simulator's own
// files.

#include <gtest/gtest.h>

#include "coast/carrier/orbits.hpp"
#include "coast/io/rinex.hpp"
#include "support/support.hpp"

namespace coast::carrier {
namespace {

class UbxOrbits : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: no recordings here";
    ubx_ = io::read_navigation(*test::data_dir() / "raw-ubx-f9p/f9p_static.ubx.gz");
  }
  record::NavigationRecording ubx_;
};

TEST_F(UbxOrbits, OfConsecutiveIssuesAgreeBetweenThem) {
  int compared = 0;
  for (std::size_t i = 1; i < ubx_.kepler.size(); ++i) {
    const auto& before = ubx_.kepler[i - 1];
    const auto& after = ubx_.kepler[i];
    if (before.satellite != after.satellite) continue;
    const geo::GpsTime middle = before.toe + 0.5 * (after.toe - before.toe);
    const SatelliteState a = satellite_state(before, middle), b = satellite_state(after, middle);
    // Fits to the same orbit: below the accuracy that they state, 2.0 and 0.25 m in range.
    EXPECT_LT((a.r_e - b.r_e).norm(), 3.0) << record::to_string(before.satellite);
    EXPECT_LT(std::abs(a.clock_s - b.clock_s), 1e-8) << record::to_string(before.satellite);
    ++compared;
  }
  EXPECT_EQ(compared, 26);
}

TEST_F(UbxOrbits, AreThoseOfTheSimulator) {
  const auto folder = *test::data_dir() / "spirent-rtk-none";
  const auto simulator = io::read_navigation({folder / "RINEX_GN_Spirent.23N", folder / "RINEX_EN_Spirent.23L"});
  int compared = 0;
  double farthest = 0.0;
  for (const auto& e : ubx_.kepler)
    for (const auto& s : simulator.kepler)
      if (e.satellite == s.satellite && e.toe == s.toe) {
        const double distance = (satellite_state(e, e.toe + 600.0).r_e - satellite_state(s, e.toe + 600.0).r_e).norm();
        farthest = std::max(farthest, distance);
        ++compared;
      }
  EXPECT_GE(compared, 18);
  EXPECT_LT(farthest, 30.0);
}

}  // namespace
}  // namespace coast::carrier
