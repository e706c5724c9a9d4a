#include "pack.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace coast::report {
namespace {

std::vector<std::uint8_t> bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

TEST(Base64, AgreesWithTheTestVectorsOfRfc4648) {  // RFC 4648 (October 2006), section 10, all seven
  const std::vector<std::pair<std::string, std::string>> vectors{{"", ""},
                                                                 {"f", "Zg=="},
                                                                 {"fo", "Zm8="},
                                                                 {"foo", "Zm9v"},
                                                                 {"foob", "Zm9vYg=="},
                                                                 {"fooba", "Zm9vYmE="},
                                                                 {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, coded] : vectors) {
    EXPECT_EQ(base64_encode(bytes_of(plain)), coded);
    EXPECT_EQ(base64_decode(coded), bytes_of(plain));
  }
}

TEST(Base64, RefusesWhatIsNotBase64) {
  for (const char* text : {"Zg=", "Z", "Zm9*", "=m9v", "Zm\n9"})
    EXPECT_THROW((void)base64_decode(text), std::invalid_argument) << text;
}

TEST(PackFloats, KeepsEveryValueToTheNearestFloat) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal(0.0, 1e4);
  std::vector<double> values{0.0, -0.0, 1e-30, -3.5e20, std::nan("")};
  for (int i = 0; i < 1000; ++i) values.push_back(normal(engine));
  const std::vector<double> back = unpack(pack_floats(values));
  ASSERT_EQ(back.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) {
      EXPECT_TRUE(std::isnan(back[i]));
    } else {
      EXPECT_LE(std::abs(back[i] - values[i]), 0x1p-24 * std::abs(values[i]));  // half a unit of the 24 bit mantissa
    }
  }
}

TEST(PackAbscissae, KeepsTenHoursAt200HzToTwentyMicroseconds) {
  std::vector<double> times;
  for (int i = 0; i < 36000 * 200; i += 37) times.push_back(457000.0 + i / 200.0);
  const nlohmann::json packed = pack_abscissae(times);
  const std::vector<double> back = unpack(packed);
  ASSERT_EQ(back.size(), times.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) worst = std::max(worst, std::abs(back[i] - times[i]));
  EXPECT_LE(worst, 0.5e-5 + 1e-9);  // half of the quantum: 36000 s / 4e9 rounded up to a power of ten; 1e-9: rounding of 4.9e5
  EXPECT_EQ(packed.at("q").get<double>(), 1e-5);
  EXPECT_LT(packed.at("z").get<std::string>().size(), times.size());  // below one character a value: equal steps vanish
  EXPECT_EQ(pack_abscissae(back), packed);                            // storing again changes nothing
}

TEST(PackAbscissae, TakesAnyOrderAndAnyLength) {
  for (const std::vector<double>& values : {std::vector<double>{}, {3.0}, {3.0, 3.0}, {2.0, 1.0, 4.0}, {-1e-9, 0.0, 1e-9}}) {
    const std::vector<double> back = unpack(pack_abscissae(values));
    ASSERT_EQ(back.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(back[i], values[i], 1e-17);  // 3e-9 of the smallest span
  }
}

TEST(Unpack, RefusesDamagedData) {
  const std::vector<double> values{1.0, 2.0, 3.0};
  nlohmann::json packed = pack_floats(values);
  packed["n"] = 4;
  EXPECT_THROW((void)unpack(packed), std::invalid_argument);
  packed["n"] = 1000000000;
  EXPECT_THROW((void)unpack(packed), std::invalid_argument);
  packed["n"] = 3;
  packed["z"] = "AAAA";
  EXPECT_THROW((void)unpack(packed), std::invalid_argument);
  packed.erase("z");
  EXPECT_THROW((void)unpack(packed), nlohmann::json::exception);
}

}  // namespace
}  // namespace coast::report
