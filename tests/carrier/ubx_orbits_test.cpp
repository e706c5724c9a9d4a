// Ephemerides that a receiver decoded from the signals of a simulator, against each other and against the simulator's own
// files.

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "coast/carrier/differences.hpp"
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
  const auto by_message = [](const record::KeplerEphemeris& e) { return std::tuple(e.satellite, e.sources, e.toe); };
  std::ranges::sort(ubx_.kepler, {}, by_message);  // Galileo has two: I/NAV and F/NAV
  for (std::size_t i = 1; i < ubx_.kepler.size(); ++i) {
    const auto& before = ubx_.kepler[i - 1];
    const auto& after = ubx_.kepler[i];
    if (before.satellite != after.satellite || before.sources != after.sources) continue;
    const geo::GpsTime middle = before.toe + 0.5 * (after.toe - before.toe);
    const SatelliteState a = satellite_state(before, middle), b = satellite_state(after, middle);
    // Fits to the same orbit, of the simulator: far below the accuracy that they state, 2.0 and 0.25 m in range.
    EXPECT_LT((a.r_e - b.r_e).norm(), 0.1) << record::to_string(before.satellite);
    EXPECT_LT(std::abs(a.clock_s - b.clock_s), 1e-9) << record::to_string(before.satellite);
    ++compared;
  }
  EXPECT_EQ(compared, 25 + 16);
}

TEST_F(UbxOrbits, PlaceTheReceiverWhereAnotherProgramDoes) {
  const auto observations = io::read_observations(*test::data_dir() / "raw-ubx-f9p/f9p_static.ubx.gz");
  const BroadcastOrbits orbits(ubx_);
  DifferenceOptions options;
  options.air.ionosphere = ubx_.gps_ionosphere;
  const auto points = single_points(observations, orbits, options);
  Eigen::Vector3d mean_e = Eigen::Vector3d::Zero();
  int found = 0;
  std::size_t left_out = 0;
  for (const auto& point : points) {
    if (!point) continue;
    mean_e += point->r_e;
    left_out += point->left_out.size();
    ++found;
  }
  mean_e /= found;
  EXPECT_GE(found, 930);
  EXPECT_LT(left_out, 20U);  // of 14 000 codes
  // From the header of the RINEX file that another converter made of the recording: one position by codes, to some metres.
  const Eigen::Vector3d r_e(-481819.2190, 5507220.7915, 3170374.0738);
  EXPECT_LT((mean_e - r_e).norm(), 5.0);
}

}  // namespace
}  // namespace coast::carrier
