// Satellites' positions and clocks against those of another program: what rnx2rtkp writes to its trace.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "coast/carrier/orbits.hpp"
#include "coast/carrier/signals.hpp"
#include "coast/io/input.hpp"
#include "coast/io/rinex.hpp"
#include "support/support.hpp"

namespace coast::carrier {
namespace {

namespace fs = std::filesystem;
using record::Satellite;
using record::SatelliteSystem;

struct Traced {
  Satellite satellite;
  geo::GpsTime t;  ///< of transmission, to a microsecond
  Eigen::Vector3d r_e;
  double clock_s = 0.0;
};

/// RTKLIB numbers GPS from 1, GLONASS from 33, Galileo from 60.
std::optional<Satellite> satellite_of(int number) {
  if (number <= 32) return Satellite{SatelliteSystem::kGps, static_cast<std::uint8_t>(number)};
  if (number >= 60 && number < 96) return Satellite{SatelliteSystem::kGalileo, static_cast<std::uint8_t>(number - 59)};
  return std::nullopt;
}

/// "4 2005/04/01 23:59:59.917287 sat= 3 rs=-24595184.341 -10320589.582   1244218.674 dts=   96721.355 var=..."
std::optional<Traced> traced(const std::string& line) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, number = 0;
  double second = 0.0, x = 0.0, y = 0.0, z = 0.0, clock_ns = 0.0;
  // NOLINTNEXTLINE(cert-err34-c): the count tells
  if (std::sscanf(line.c_str(), "4 %d/%d/%d %d:%d:%lf sat=%d rs=%lf %lf %lf dts=%lf", &year, &month, &day, &hour, &minute,
                  &second, &number, &x, &y, &z, &clock_ns) != 11)
    return std::nullopt;
  const auto satellite = satellite_of(number);
  if (!satellite) return std::nullopt;
  return Traced{*satellite, geo::GpsTime::from_calendar({year, month, day, hour, minute, second}), {x, y, z}, 1e-9 * clock_ns};
}

/// By the satellite's ephemeris that comes nearest: of Galileo's two messages the other program may take the other one.
SatelliteState nearest(const record::NavigationRecording& broadcast, const Traced& theirs) {
  const auto off = [&theirs](const SatelliteState& state) {
    return (state.r_e - theirs.r_e).norm() + std::abs(state.clock_s - theirs.clock_s) * kSpeedOfLight;
  };
  SatelliteState best;
  for (const record::KeplerEphemeris& e : broadcast.kepler) {
    if (e.satellite != theirs.satellite || std::abs(e.toe - theirs.t) > 14400.0) continue;
    const SatelliteState state = satellite_state(e, theirs.t);
    if (off(state) < off(best)) best = state;
  }
  return best;
}

struct Files {
  const char* rover;
  std::vector<const char*> navigation;
  std::size_t least;  ///< satellites' positions
};

class RtklibOrbits : public testing::TestWithParam<Files> {};

TEST_P(RtklibOrbits, ArePlacedWithinAMillimetre) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: the real recordings are not at hand";
  if (std::system("command -v rnx2rtkp >/dev/null") != 0) GTEST_SKIP() << "rnx2rtkp (Debian's rtklib) is not installed";
  const test::TemporaryDirectory folder;
  const auto unpacked = [&](const char* name, const std::string& as) {  // it would unpack beside the recording
    std::ofstream(folder.path() / as) << io::read_all(*test::data_dir() / name);
    return (folder.path() / as).string();
  };
  std::string command = fmt::format("rnx2rtkp -x 4 -p 0 -sys G,E -o '{}' '{}'", (folder.path() / "o.pos").string(),
                                    unpacked(GetParam().rover, "rover.obs"));
  std::vector<fs::path> navigation;
  for (const char* name : GetParam().navigation) {
    navigation.emplace_back(unpacked(name, fmt::format("{}.nav", navigation.size())));
    command += fmt::format(" '{}'", navigation.back().string());
  }
  ASSERT_EQ(std::system((command + " >/dev/null 2>&1").c_str()), 0);
  const record::NavigationRecording broadcast = io::read_navigation(navigation);
  std::ifstream trace(folder.path() / "o.pos.trace");
  std::size_t compared = 0;
  for (std::string line; std::getline(trace, line);) {
    const std::optional<Traced> theirs = traced(line);
    if (!theirs) continue;
    const SatelliteState ours = nearest(broadcast, *theirs);
    const Eigen::Vector3d off = ours.r_e - theirs->r_e;
    const Eigen::Vector3d way = ours.v_e.normalized();
    // Half a microsecond of the printed time at 4 km/s, along the way; half a millimetre of each printed coordinate.
    EXPECT_LT(std::abs(off.dot(way)), 0.003) << line;
    EXPECT_LT((off - off.dot(way) * way).norm(), 0.001) << line;
    EXPECT_NEAR(ours.clock_s * kSpeedOfLight, theirs->clock_s * kSpeedOfLight, 0.001) << line;
    ++compared;
  }
  EXPECT_GT(compared, GetParam().least);
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, RtklibOrbits,
    testing::Values(Files{"rinex-gsi-2005-092/07590920.05o", {"rinex-gsi-2005-092/30400920.05n"}, 800},
                    Files{"rinex-kinematic-2021-265/SEPT265G.21O.gz", {"rinex-kinematic-2021-265/SEPT2650.21P.gz"}, 2000}),
    [](const testing::TestParamInfo<Files>& files) { return fmt::format("n{}", files.index); });

}  // namespace
}  // namespace coast::carrier
