#include "coast/io/products.hpp"

#include <gtest/gtest.h>

#include "io/files.hpp"

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

}  // namespace
}  // namespace coast
