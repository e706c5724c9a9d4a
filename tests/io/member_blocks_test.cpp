// What the members of a synthetic IMU measured, as a file.

#include "coast/io/member_blocks.hpp"

#include <gtest/gtest.h>

#include "coast/record/error.hpp"
#include "io/files.hpp"

namespace coast::io {
namespace {

const std::string kMemberHeader =
    "gps_week,from_sow_s,span_s,member,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n";

TEST(MemberBlocks, AreReadAsTheyWereWritten) {
  record::MemberBlocks members;
  members.names = {"left", "right one"};
  const geo::GpsTime start = geo::GpsTime::from_week(2300, 604799.5);
  for (int i = 0; i < 3; ++i) {
    record::MemberBlocks::Block block{start + i, start + (i + 1), {}};
    block.means.resize(2);
    block.means[1] = {{0.1 * i, 1e-7, -2.0}, {9.8, -0.1, 1e-6 * i}};
    if (i != 1) block.means[0] = {{1.0, 2.0, 3.0 * i}, {4.0, 5.0, 6.0}};
    members.blocks.push_back(block);
  }
  const test::Files files;
  const std::filesystem::path file = files.put("members.csv", "");
  write_member_blocks(file, members);
  const record::MemberBlocks again = read_member_blocks(file, members.names);
  ASSERT_EQ(again.blocks.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(again.blocks[i].from - members.blocks[i].from, 0.0, 1e-6);  // as printed
    EXPECT_NEAR(again.blocks[i].to - members.blocks[i].to, 0.0, 1e-6);
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_EQ(again.blocks[i].means[k].has_value(), members.blocks[i].means[k].has_value());
      if (!again.blocks[i].means[k]) continue;
      EXPECT_LE((again.blocks[i].means[k]->gyro - members.blocks[i].means[k]->gyro).norm(), 1e-13);
      EXPECT_LE((again.blocks[i].means[k]->accel - members.blocks[i].means[k]->accel).norm(), 1e-12);
    }
  }
  // Another order of names is another order of places.
  EXPECT_EQ(read_member_blocks(file, {"right one", "left"}).blocks[1].means[1], std::nullopt);
}

TEST(MemberBlocks, SpoiledFilesAreRefusedWithTheirLine) {
  const auto refused = [](const std::string& rows, const char* said) {
    const test::Files files;
    try {
      (void)read_member_blocks(files.put("members.csv", kMemberHeader + rows), {"left", "right"});
      ADD_FAILURE() << rows;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(said), std::string::npos) << e.what();
    }
  };
  const auto row = [](const std::string& from, const std::string& span, const std::string& member) {
    return "2300," + from + "," + span + "," + member + ",0,0,0,0,0,9.8\n";
  };
  refused(row("100", "1", "left") + row("100", "1", "left"), ":3");
  refused(row("100", "1", "left") + row("100", "2", "right"), "span");
  refused(row("100", "1", "left") + row("100.5", "1", "left"), "in order");
  refused(row("100", "1", "top"), "left, right");
  refused(row("100", "-1", "left"), "span");
  refused(row("100", "1e-10", "left"), "1e-3");
  refused(row("100", "nan", "left"), "not a number");
  refused(row("nan", "1", "left"), "not a time");
}

}  // namespace
}  // namespace coast::io
