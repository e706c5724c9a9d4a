// Noise over time, as a file.

#include "coast/io/noise_levels.hpp"

#include <gtest/gtest.h>

#include "coast/record/error.hpp"
#include "io/files.hpp"

namespace coast::io {
namespace {

constexpr const char* kLevelHeader =
    "gps_week,sow_s,gyro_x_radps_rthz,gyro_y_radps_rthz,gyro_z_radps_rthz,accel_x_mps2_rthz,accel_y_mps2_rthz,accel_z_mps2_"
    "rthz\n";

TEST(NoiseLevels, AreRelativeToTheirMeans) {
  const test::Files files;
  const auto levels = read_noise_levels(files.put(
      "noise.csv", std::string(kLevelHeader) + "2300,100,1e-3,1,2,3,4,5\n2300,103,2e-3,1,2,3,4,5\n2300,104,1e-3,1,2,6,4,5\n"));
  ASSERT_EQ(levels.size(), 3U);
  EXPECT_EQ(levels[0].to, levels[1].from);
  EXPECT_EQ(levels[2].to - levels[2].from, 1.0);  // as long as the one before
  // Powers 1, 4, 1 over 3, 1, 1 s have a mean of 8/5; 9, 9, 36 one of 72/5.
  EXPECT_NEAR(levels[0].gyro.x(), 5.0 / 8.0, 1e-15);
  EXPECT_NEAR(levels[1].gyro.x(), 20.0 / 8.0, 1e-15);
  EXPECT_NEAR(levels[2].accel.x(), 2.5, 1e-15);
  EXPECT_NEAR(levels[1].accel.z(), 1.0, 1e-15);
}

TEST(NoiseLevels, SpoiledFilesAreRefusedWithTheirLine) {
  const auto refused = [](const std::string& rows, const char* said) {
    const test::Files files;
    try {
      (void)read_noise_levels(files.put("noise.csv", kLevelHeader + rows));
      ADD_FAILURE() << rows;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(said), std::string::npos) << e.what();
    }
  };
  refused("2300,100,1,1,1,1,1,1\n", "two rows");
  refused("2300,100,1,1,1,1,1,1\n2300,100,1,1,1,1,1,1\n", ":3");
  refused("2300,100,1,1,1,1,1,1\n2300,101,1,0,1,1,1,1\n", "above zero");
  refused("2300,100,1,1,1,1,1,1\n2300,101,1,nan,1,1,1,1\n", "above zero");
  refused("nan,100,1,1,1,1,1,1\n2300,101,1,1,1,1,1,1\n", "not a time");
  refused("2300,nan,1,1,1,1,1,1\n2300,101,1,1,1,1,1,1\n", "not a time");
  refused("2300,100,1,1,1,1,1,1\n2300,700000,1,1,1,1,1,1\n", "not a time");
}

}  // namespace
}  // namespace coast::io
