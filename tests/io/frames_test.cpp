// Frames of receivers' messages in files that hold them whole, mixed, damaged and cut.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "../../src/io/frames/checksums.hpp"
#include "../../src/io/frames/frame_stream.hpp"
#include "io/files.hpp"
#include "io/receiver_messages.hpp"

namespace coast::io {
namespace {

using test::nmea;
using test::rtcm3;
using test::ubx;

constexpr std::uint32_t kPvt = 0x0107;

struct Seen {
  struct One {
    Protocol protocol;
    std::uint32_t id;
    std::string payload;
    std::uint64_t position;
  };
  std::vector<One> frames;
  FrameCensus census;
};

Seen frames_of(const std::string& content) {
  const test::Files files;
  FrameStream stream(files.put("log.ubx", content), kUbxLog);
  Seen seen;
  MessageFrame frame;
  while (stream.next(frame)) seen.frames.push_back({frame.protocol, frame.id, std::string(frame.payload), frame.position});
  seen.census = stream.census();
  return seen;
}

std::string kinds_of(const record::Events& events) {
  std::string kinds;
  for (const record::Event& event : events) kinds += (kinds.empty() ? "" : " ") + event.kind;
  return kinds;
}

TEST(Checksums, AgreeWithPublishedAndBitwiseOnes) {
  const std::string digits = "123456789";
  EXPECT_EQ(crc16_ccitt(digits), 0x31C3);  // CRC-16/XMODEM
  EXPECT_EQ(crc24q(digits), test::crc_bit_by_bit(digits, 0x864CFB, 24));
  // The poll of MON-VER: B5 62 0A 04 00 00 0E 34.
  EXPECT_EQ(fletcher8(std::string("\x0a\x04\x00\x00", 4)), 0x340E);
}

TEST(Frames, OfSeveralProtocolsAreToldApart) {
  const std::string pvt(92, '\x07');
  const std::string content = nmea("GNGGA,,,,,,0,00,99.99,,,,,,") + ubx(1, 7, pvt) + rtcm3(1077, 300) + ubx(2, 0x15, "") +
                              nmea("PUBX,00,1") + ubx(1, 7, pvt);
  const Seen seen = frames_of(content);
  ASSERT_EQ(seen.frames.size(), 6U);
  EXPECT_EQ(seen.frames[1].payload, pvt);
  EXPECT_EQ(seen.frames[1].position, nmea("GNGGA,,,,,,0,00,99.99,,,,,,").size());
  EXPECT_EQ(seen.frames[2].payload.size(), 300U);
  EXPECT_EQ(seen.census.number(Protocol::kUbx, kPvt), 2);
  EXPECT_EQ(seen.census.number(Protocol::kRtcm3, 1077), 1);
  EXPECT_EQ(seen.census.number(Protocol::kUbx, 0x0215), 1);
  std::string names;
  for (const auto& [key, number] : seen.census.frames) names += frame_name(key.first, key.second) + ";";
  EXPECT_EQ(names, "UBX-NAV-PVT;UBX-RXM-RAWX;NMEA GGA;NMEA UBX;RTCM 1077;");
  EXPECT_EQ(frame_name(Protocol::kUbx, 0x0259), "UBX 0x02 0x59");
  EXPECT_TRUE(seen.census.events("log.ubx").empty());
}

TEST(Frames, AreFoundAgainAfterGarbageAndFalseBeginnings) {
  const std::string good = ubx(1, 7, std::string(92, 'x'));
  // A beginning that states 8000 bytes hides none of the frames that follow inside of them; likewise of RTCM and NMEA.
  const std::string false_ubx("\xb5\x62\x01\x07\x40\x1f", 6), false_rtcm("\xd3\x03\xff", 3);
  for (const std::string& between :
       {std::string("\xb5"), std::string("\xb5\xb5\x62"), false_ubx, false_rtcm, std::string("$GNGGA,12"),
        std::string(5000, '\x11'), std::string("\xb5\x62\xff\xff\xff\xff")}) {
    const Seen seen = frames_of(between + good + between + good + good);
    ASSERT_EQ(seen.frames.size(), 3U) << between.size();
    EXPECT_EQ(seen.census.skipped, 2 * between.size());
    EXPECT_EQ(seen.frames[0].position, between.size());
    const std::string kinds = kinds_of(seen.census.events("log.ubx"));
    EXPECT_NE(kinds.find("message_garbage"), std::string::npos) << kinds;
    EXPECT_EQ(kinds.find("cut_off"), std::string::npos) << kinds;
  }
}

TEST(Frames, WithAWrongByteAreLeftOutAndCounted) {
  const std::string one = ubx(1, 7, std::string(92, 'x')), line = nmea("GNGLL,,,,,101154.00,V,N"), message = rtcm3(1005, 19);
  for (std::size_t at = 0; at < one.size(); ++at) {
    std::string spoiled = one;
    spoiled[at] = static_cast<char>(spoiled[at] ^ 0x10);
    const Seen seen = frames_of(one + spoiled + one);
    ASSERT_EQ(seen.frames.size(), 2U) << at;
    EXPECT_EQ(seen.census.skipped, one.size()) << at;
  }
  std::string wrong_line = line, wrong_message = message, wrong_one = one;
  wrong_line[3] = 'A';
  wrong_message[9] = 'A';
  wrong_one[9] = 'A';
  const Seen seen = frames_of(one + line + message + wrong_one + wrong_line + wrong_message + one);
  EXPECT_EQ(seen.frames.size(), 4U);
  for (const FrameCensus::Bad& bad : {seen.census.bad_checksums[0], seen.census.bad_checksums[1], seen.census.bad_checksums[2]})
    EXPECT_EQ(bad.number, 1);
  EXPECT_EQ(seen.census.bad_checksums[0].first, one.size() + line.size() + message.size());
  EXPECT_EQ(kinds_of(seen.census.events("log.ubx")), "message_checksum message_checksum message_checksum message_garbage");
}

TEST(Frames, CutOffByTheEndAreNamed) {
  for (const std::string& last : {ubx(1, 7, std::string(92, 'x')), nmea("GNGLL,,,,,101154.00,V,N"), rtcm3(1005, 19)}) {
    for (std::size_t size = 1; size < last.size(); ++size) {
      const Seen seen = frames_of(ubx(5, 1, "ab") + last.substr(0, size));
      ASSERT_EQ(seen.frames.size(), 1U);
      EXPECT_EQ(seen.census.cut_off, size);
      EXPECT_EQ(kinds_of(seen.census.events("log.ubx")), "message_cut_off");
    }
  }
}

TEST(Frames, LongerThanAWindowOfFileAreReadAcrossItsEdges) {
  std::mt19937 random(7);
  std::string content;
  std::vector<std::string> payloads;
  while (content.size() < 8 * ByteWindow::kMost) {
    std::string payload(random() % 8185, '\0');
    for (char& c : payload) c = static_cast<char>(random());
    content += ubx(2, 0x15, payload);
    payloads.push_back(std::move(payload));
    if (random() % 3 == 0) content += nmea("GNTXT,01,01,02,nothing");
  }
  const Seen seen = frames_of(content);
  std::size_t i = 0;
  for (const Seen::One& frame : seen.frames)
    if (frame.protocol == Protocol::kUbx) {
      ASSERT_LT(i, payloads.size());
      EXPECT_EQ(frame.payload, payloads[i++]);
    }
  EXPECT_EQ(i, payloads.size());
  EXPECT_EQ(seen.census.skipped, 0U);
}

TEST(Frames, OfRandomBytesAreHardlyAny) {
  std::mt19937 random(11);
  std::string content(1 << 20, '\0');
  for (char& c : content) c = static_cast<char>(random());
  const Seen seen = frames_of(content);
  std::uint64_t inside = 0;
  for (const Seen::One& frame : seen.frames) inside += frame.payload.size() + 8;
  EXPECT_LT(seen.frames.size(), 4U);  // 2^20 beginnings, of which 2^-16 and then 2^-16 (UBX), or 2^-14 and 2^-24 (RTCM)
  EXPECT_LE(seen.census.skipped, content.size());
  EXPECT_GE(seen.census.skipped + inside, content.size());
}

}  // namespace
}  // namespace coast::io
