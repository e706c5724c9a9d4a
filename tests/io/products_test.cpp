#include "coast/io/products.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/files.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

const std::string kHeader =
    "#cP2010  7  1  0  0  0.00000000      96 ORBIT IGS05 HLM  IGS\n"
    "## 1590 345600.00000000   900.00000000 55378 0.0000000000000\n"
    "%c G  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n";

TEST(Sp3, PositionsAndClocks) {
  const test::Files files;
  files.put("a.sp3", kHeader +
                         "*  2010  7  1  0  0  0.00000000\n"
                         "PG01 -14221.541216  15014.532180  16665.311482    345.123456  7  8  9 100\n"
                         "PG02      0.000000      0.000000      0.000000 999999.999999\n"
                         "PR07  -8423.160541  22713.232180 -11066.543210 999999.999999\n"
                         "VR07  1.0 2.0 3.0 4.0\n"
                         "EOF\n");
  files.put("b.sp3", kHeader +
                         "*  2010  7  1  0 15  0.00000000\n"
                         "PG01 -14300.541216  15014.532180  16665.311482    345.123456\n"
                         "PG01 -99999.9x\n"
                         "*  2010  7  1  0  0  0.00000000\n"
                         "PG01 -10000.000000  15014.532180  16665.311482    345.123456\n");
  const auto orbits = io::read_sp3({files.path("b.sp3"), files.path("a.sp3")});
  ASSERT_EQ(orbits.points.size(), 2U);
  const auto& g01 = orbits.points.at({record::SatelliteSystem::kGps, 1});
  ASSERT_EQ(g01.size(), 2U);  // in order of time, the first of two that are there twice
  EXPECT_EQ(g01[0].t, geo::GpsTime::from_calendar({2010, 7, 1, 0, 0, 0.0}));
  EXPECT_EQ(g01[0].r_e.x(), -1e7);
  EXPECT_NEAR(*g01[0].clock_s, 345.123456e-6, 1e-18);
  EXPECT_FALSE(orbits.points.at({record::SatelliteSystem::kGlonass, 7})[0].clock_s);
  EXPECT_EQ(test::count_of(orbits.events, "sp3_spoiled"), 1);
}

TEST(Sp3, RefusesWithTheLine) {
  const test::Files files;
  const auto said = [&](const std::string& content) {
    files.put("x.sp3", content);
    return test::refusal([&] { static_cast<void>(io::read_sp3({files.path("x.sp3")})); });
  };
  EXPECT_NE(said("hello\n").find("x.sp3:1"), std::string::npos);
  EXPECT_NE(said(kHeader).find("no epoch"), std::string::npos);
  EXPECT_NE(said(kHeader + "*  2010 13  1  0  0  0.00000000\n").find("x.sp3:4"), std::string::npos);
}

/// A header line: sixty columns of text, then its label.
std::string labelled(const std::string& text, const std::string& label, std::size_t width = 60) {
  return fmt::format("{:<{}}{}\n", text, width, label);
}

TEST(RinexClock, SatellitesOfBothLayouts) {
  const test::Files files;
  files.put("a.clk", labelled("     3.00           C", "RINEX VERSION / TYPE") + labelled("", "END OF HEADER") +
                         "AR GUAT 2010 07 01 00 00  0.000000  2   -4.916326519995e-09  2.312728830790e-11\n"
                         "AS G01  2010 07 01 00 05  0.000000  2    1.250010000000e-04  2.312728830790e-11\n"
                         "AS G01  2010 07 01 00 00  0.000000  2    1.250000000000e-04  2.312728830790e-11\n"
                         "AS G02  2010 07 01 00 00  0.000000  1    x\n");
  files.put("b.clk", labelled("3.04                 C", "RINEX VERSION / TYPE", 65) + labelled("   UTC", "TIME SYSTEM ID", 65) +
                         labelled("", "END OF HEADER", 65) +
                         "AS E11       2010 07 01 00 00  0.000000  1    -2.500000000000E-05\n");
  const auto clocks = io::read_clocks({files.path("a.clk"), files.path("b.clk")});
  ASSERT_EQ(clocks.points.size(), 2U);
  const auto& g01 = clocks.points.at({record::SatelliteSystem::kGps, 1});
  ASSERT_EQ(g01.size(), 2U);
  EXPECT_EQ(g01[0].t, geo::GpsTime::from_calendar({2010, 7, 1, 0, 0, 0.0}));
  EXPECT_EQ(g01[0].clock_s, 1.25e-4);
  const auto& e11 = clocks.points.at({record::SatelliteSystem::kGalileo, 11});
  EXPECT_EQ(e11[0].t, geo::GpsTime::from_utc({2010, 7, 1, 0, 0, 0.0}));
  EXPECT_EQ(e11[0].clock_s, -2.5e-5);
  EXPECT_EQ(test::count_of(clocks.events, "clocks_spoiled"), 1);
}

TEST(RinexClock, RefusesWithTheLine) {
  const test::Files files;
  const auto said = [&](const std::string& content) {
    files.put("x.clk", content);
    return test::refusal([&] { static_cast<void>(io::read_clocks({files.path("x.clk")})); });
  };
  EXPECT_NE(said("hello\n").find("x.clk:1"), std::string::npos);
  EXPECT_NE(said(labelled("     3.00           O", "RINEX VERSION / TYPE")).find("clock"), std::string::npos);
  EXPECT_NE(said(labelled("     3.00           C", "RINEX VERSION / TYPE")).find("END OF HEADER"), std::string::npos);
  EXPECT_NE(said(labelled("     3.00           C", "RINEX VERSION / TYPE") + labelled("", "END OF HEADER")).find("AS"),
            std::string::npos);
}

std::string antenna(const std::string& type, const std::string& row) {
  return labelled("", "START OF ANTENNA") + labelled(type, "TYPE / SERIAL NO") + labelled("     0.0", "DAZI") +
         labelled("     0.0  90.0  30.0", "ZEN1 / ZEN2 / DZEN") + labelled("   G01", "START OF FREQUENCY") +
         labelled("      1.00     -2.00     90.00", "NORTH / EAST / UP") + row + labelled("   G01", "END OF FREQUENCY") +
         labelled("", "END OF ANTENNA");
}

TEST(Antex, OffsetsAndVariations) {
  const test::Files files;
  const std::string head = labelled("     1.4            M", "ANTEX VERSION / SYST") + labelled("A", "PCV TYPE / REFANT");
  files.put("a.atx", head + antenna("MADE1           NONE", "   NOAZI    0.00   -1.00   -2.00   -3.00\n") +
                         antenna("MADE2           NONE", "   NOAZI    0.00   -1.00   -2.00\n"));
  const auto table = io::read_antex(files.path("a.atx"));
  ASSERT_EQ(table.antennas.size(), 1U);
  EXPECT_EQ(test::count_of(table.events, "antex_spoiled"), 1);
  const record::AntennaCalibration& made = table.antennas[0];
  EXPECT_EQ(made.type, "MADE1           NONE");
  EXPECT_FALSE(made.satellite);
  const record::PhaseCentre& centre = made.bands.at({record::SatelliteSystem::kGps, '1'});
  EXPECT_EQ(centre.offset, Eigen::Vector3d(1e-3, -2e-3, 90e-3));
  ASSERT_EQ(centre.variations.size(), 1U);
  EXPECT_EQ(centre.variations[0], (std::vector<double>{0.0, -1e-3, -2e-3, -3e-3}));
  files.put("b.atx", "hello\n");
  EXPECT_NE(test::refusal([&] { static_cast<void>(io::read_antex(files.path("b.atx"))); }).find("b.atx:1"), std::string::npos);
  files.put("c.atx", labelled("     1.3            M", "ANTEX VERSION / SYST") + labelled("R", "PCV TYPE / REFANT"));
  EXPECT_NE(test::refusal([&] { static_cast<void>(io::read_antex(files.path("c.atx"))); }).find("relative"), std::string::npos);
}

TEST(Products, RealFilesAreReadWhole) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: no recordings here";
  const auto clocks = io::read_clocks({*test::data_dir() / "rinex-esbc-2020-177/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz"});
  EXPECT_EQ(clocks.points.at({record::SatelliteSystem::kGps, 1}).size(), 2880U);  // as its description says
  EXPECT_TRUE(clocks.events.empty());
  const auto antennas = io::read_antex(*test::data_dir() / "orbits-2010-182/igs05.atx.gz");
  EXPECT_TRUE(antennas.events.empty());
  const auto trimble = std::ranges::find(antennas.antennas, "TRM29659.00     NONE", &record::AntennaCalibration::type);
  ASSERT_NE(trimble, antennas.antennas.end());
  const record::PhaseCentre& centre = trimble->bands.at({record::SatelliteSystem::kGps, '1'});
  // Lines 15909 and 15912 of the file: columns at zenith and 20 degrees, 5 degrees of azimuth.
  EXPECT_EQ(centre.offset, Eigen::Vector3d(-0.06e-3, -0.91e-3, 91.95e-3));
  ASSERT_EQ(centre.variations.size(), 73U);
  EXPECT_NEAR(centre.variations[1][4], -3.36e-3, 1e-12);
}

}  // namespace
}  // namespace coast
