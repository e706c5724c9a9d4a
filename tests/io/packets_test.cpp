#include "coast/io/packets.hpp"

#include <gtest/gtest.h>

#include "coast/io/yaml.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"

namespace coast::io {
namespace {

constexpr const char* kPacketMap = R"(
file: log.csv
columns: {counter: n, arrival: t, gps: gps, pulse: pulse, gyro: [gx, gy, gz], accel: [ax, ay, az]}
units: {gyro: deg/s, accel: g}
)";
constexpr const char* kPacketHeader = "n,t,gps,pulse,gx,gy,gz,ax,ay,az\n";

record::PacketRecording packets_of(const std::string& rows) {
  const test::Files files;
  PacketFileOptions options = PacketFileOptions::from(parse_yaml(kPacketMap, "array.yaml"));
  options.file = files.put("log.csv", kPacketHeader + rows);
  return read_packets(options);
}

TEST(Packets, AreReadWithWhatEachRowHas) {
  const record::PacketRecording recording = packets_of("65535,10.25,345600.5,,180,0,0,0,0,-1\n0,10.26,,7,0,180,0,1,0,0\n");
  ASSERT_EQ(recording.packets.size(), 2U);
  EXPECT_EQ(recording.packets[0].counter, 65535);
  EXPECT_EQ(recording.packets[0].arrival_s, 10.25);
  EXPECT_EQ(recording.packets[0].master_s, 345600.5);
  EXPECT_FALSE(recording.packets[0].pulse);
  EXPECT_FALSE(recording.packets[1].master_s);
  EXPECT_EQ(recording.packets[1].pulse, 7);
  EXPECT_EQ(recording.packets[1].row, 1U);
  EXPECT_DOUBLE_EQ(recording.rates[0].x(), 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(recording.forces[0].z(), -9.80665);
}

TEST(Packets, RowsThatAreNotFiniteAreLeftOutAndCounted) {
  const record::PacketRecording recording = packets_of("0,1,,,1,2,3,4,5,6\n1,2,,,nan,2,3,4,5,6\n2,3,,,1,2,3,4,5,6\n");
  EXPECT_EQ(recording.packets.size(), 2U);
  EXPECT_EQ(recording.packets[1].row, 1U);
  ASSERT_EQ(recording.events.size(), 1U);
  EXPECT_EQ(recording.events[0].kind, "nan_row");
}

TEST(Packets, ThatCannotBeAreRefusedWithTheirLine) {
  for (const char* rows : {"0.5,1,,,1,2,3,4,5,6\n1,2,,,1,2,3,4,5,6\n", "0,1,,,1,2,3,4,5,6\n-1,2,,,1,2,3,4,5,6\n",
                           "0,1,7e5,,1,2,3,4,5,6\n1,2,,,1,2,3,4,5,6\n", "0,1,,1.5,1,2,3,4,5,6\n1,2,,,1,2,3,4,5,6\n",
                           "0,1,,,1,2,3,4,5,6\n", "0,1,,,1e9,2,3,4,5,6\n1,2,,,1,2,3,4,5,6\n"})
    EXPECT_THROW(static_cast<void>(packets_of(rows)), InputError) << rows;
}

}  // namespace
}  // namespace coast::io
