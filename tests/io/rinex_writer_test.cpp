// What is written as RINEX reads back as it was.

#include <gtest/gtest.h>

#include "coast/io/rinex.hpp"
#include "support/support.hpp"

namespace coast::io {
namespace {

using record::Observation;
using record::SatelliteSystem;

record::ObservationRecording observations() {
  record::ObservationRecording recording;
  recording.marker = "TEST";
  recording.receiver = "MAKE";
  recording.antenna = "TRM59800.00     SCIS";
  recording.approximate_r_e = Eigen::Vector3d(4e6, 5e5, 4.9e6);
  recording.antenna_offset_enu = {0.1, -0.2, 1.3};
  for (int slot = 1; slot <= 10; ++slot) recording.glonass_channels[slot] = slot - 7;
  for (int i = 0; i < 3; ++i) {
    record::ObservationEpoch& epoch = recording.epochs.emplace_back();
    epoch.t = geo::GpsTime::from_week(2374, 208800.0 + i);
    for (const SatelliteSystem system : {SatelliteSystem::kGps, SatelliteSystem::kGlonass, SatelliteSystem::kGalileo})
      for (const char band : {'1', '5'}) {
        Observation o;
        o.satellite = {system, 7};
        o.signal = {band, 'C'};
        o.code_m = 2.1e7 + 0.125 * i;
        if (band == '1' || i > 0) o.phase_cycles = -1.1e8 - 0.375 * i;
        o.doppler_hz = 1234.5;
        o.cn0_dbhz = 43.25;
        o.lost_lock = i == 1;
        o.half_cycle = i == 2 && band == '1';
        epoch.observations.push_back(o);
      }
  }
  return recording;
}

class RinexWriter : public testing::TestWithParam<RinexVersion> {};

TEST_P(RinexWriter, ObservationsReadBack) {
  const test::TemporaryDirectory folder;
  const record::ObservationRecording written = observations();
  write_observations(folder.path() / "a.obs", written, GetParam());
  const record::ObservationRecording read = read_observations(folder.path() / "a.obs");
  EXPECT_EQ(read.marker, written.marker);
  EXPECT_EQ(read.antenna, written.antenna);
  EXPECT_EQ(read.antenna_offset_enu, written.antenna_offset_enu);
  EXPECT_EQ(read.glonass_channels, written.glonass_channels);
  ASSERT_TRUE(read.approximate_r_e);
  EXPECT_EQ(*read.approximate_r_e, *written.approximate_r_e);
  ASSERT_EQ(read.epochs.size(), written.epochs.size());
  for (std::size_t i = 0; i < read.epochs.size(); ++i) {
    EXPECT_EQ(read.epochs[i].t, written.epochs[i].t);
    ASSERT_EQ(read.epochs[i].observations.size(), written.epochs[i].observations.size());
    for (std::size_t k = 0; k < read.epochs[i].observations.size(); ++k) {
      const Observation &a = read.epochs[i].observations[k], &b = written.epochs[i].observations[k];
      EXPECT_EQ(a.satellite, b.satellite);
      EXPECT_EQ(a.signal, b.signal);
      EXPECT_EQ(a.code_m, b.code_m);
      EXPECT_EQ(a.phase_cycles, b.phase_cycles);
      EXPECT_EQ(a.doppler_hz, b.doppler_hz);
      EXPECT_EQ(a.cn0_dbhz, b.cn0_dbhz);
      if (!b.phase_cycles) continue;  // flags stand beside a phase
      EXPECT_EQ(a.lost_lock, b.lost_lock);
      EXPECT_EQ(a.half_cycle, b.half_cycle);
    }
  }
  EXPECT_TRUE(read.events.empty());
}

TEST_P(RinexWriter, EphemeridesReadBack) {
  record::NavigationRecording written;
  const auto kepler = [&](SatelliteSystem system, std::uint8_t number, int sources) {
    record::KeplerEphemeris e;
    e.satellite = {system, number};
    e.toe = e.toc = geo::GpsTime::from_week(2374, 7200.0);
    if (system == SatelliteSystem::kBeidou) e.toe = e.toc = e.toe + 14.0;  // whole seconds of its own time
    e.clock = {1.25e-4, -3e-12, 0.0};
    e.sqrt_a = 5153.7;
    e.eccentricity = 0.01;
    e.mean_anomaly = 1.5;
    e.node = -2.0;
    e.inclination = 0.96;
    e.crs = -12.5;
    e.issue = 17;
    e.sources = sources;
    e.accuracy_m = 2.0;
    e.group_delay = {-1.1e-8, system == SatelliteSystem::kGps ? 0.0 : 2e-9};
    written.kepler.push_back(e);
  };
  kepler(SatelliteSystem::kGps, 3, 1);
  kepler(SatelliteSystem::kGalileo, 11, 517);
  kepler(SatelliteSystem::kGalileo, 12, 258);
  kepler(SatelliteSystem::kBeidou, 3, 0);
  kepler(SatelliteSystem::kBeidou, 23, 0);
  record::TabulatedEphemeris glonass;
  glonass.satellite = {SatelliteSystem::kGlonass, 5};
  glonass.t = geo::GpsTime::from_utc({2025, 7, 8, 10, 15, 0.0});
  glonass.clock_bias = -5e-5;
  glonass.r_e = {1e7, -2e7, 1.1e7};
  glonass.v_e = {1500.0, 300.0, -2800.0};
  glonass.a_e = {1e-6, 0.0, -2e-6};
  glonass.channel = -4;
  written.tabulated.push_back(glonass);
  const test::TemporaryDirectory folder;
  write_navigation(folder.path() / "a.nav", written, GetParam());
  const record::NavigationRecording read = read_navigation(folder.path() / "a.nav");
  ASSERT_EQ(read.kepler.size(), written.kepler.size());
  for (const record::KeplerEphemeris& b : written.kepler) {
    const auto a = std::ranges::find(read.kepler, b.satellite, &record::KeplerEphemeris::satellite);
    ASSERT_NE(a, read.kepler.end()) << to_string(b.satellite);
    EXPECT_EQ(a->toe, b.toe) << to_string(b.satellite);
    EXPECT_EQ(a->toc, b.toc);
    EXPECT_EQ(a->clock, b.clock);
    EXPECT_EQ(a->sqrt_a, b.sqrt_a);
    EXPECT_EQ(a->mean_anomaly, b.mean_anomaly);
    EXPECT_EQ(a->node, b.node);
    EXPECT_EQ(a->crs, b.crs);
    EXPECT_EQ(a->issue, b.issue);
    EXPECT_EQ(a->sources, b.sources);
    EXPECT_EQ(a->group_delay, b.group_delay) << to_string(b.satellite);
  }
  ASSERT_EQ(read.tabulated.size(), 1U);
  EXPECT_EQ(read.tabulated[0].t, glonass.t);
  EXPECT_LT((read.tabulated[0].r_e - glonass.r_e).norm(), 1e-4);
  EXPECT_LT((read.tabulated[0].v_e - glonass.v_e).norm(), 1e-8);
  EXPECT_EQ(read.tabulated[0].channel, glonass.channel);
}

INSTANTIATE_TEST_SUITE_P(Versions, RinexWriter, testing::Values(RinexVersion::kThree, RinexVersion::kFour),
                         [](const testing::TestParamInfo<RinexVersion>& version) {
                           return version.param == RinexVersion::kThree ? "v3" : "v4";
                         });

TEST(NavigationFiles, OfSeveralSystemsBecomeOne) {
  record::NavigationRecording gps, galileo;
  record::KeplerEphemeris e;
  e.toe = e.toc = geo::GpsTime::from_week(2374, 7200.0);
  e.sqrt_a = 5153.7;
  e.satellite = {SatelliteSystem::kGps, 3};
  gps.kepler = {e};
  e.satellite = {SatelliteSystem::kGalileo, 3};
  galileo.kepler = {e};
  const test::TemporaryDirectory folder;
  write_navigation(folder.path() / "a.nav", gps);
  write_navigation(folder.path() / "b.nav", galileo);
  const auto all = read_navigation({folder.path() / "b.nav", folder.path() / "a.nav", folder.path() / "a.nav"});
  ASSERT_EQ(all.kepler.size(), 2U);
  EXPECT_EQ(all.kepler[0].satellite.system, SatelliteSystem::kGps);
  EXPECT_EQ(all.kepler[1].satellite.system, SatelliteSystem::kGalileo);
}

}  // namespace
}  // namespace coast::io
