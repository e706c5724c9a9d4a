#include "coast/array/packets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>

namespace coast::array {
namespace {

/// What a device at 100 Hz sends from a counter on: every packet late by 1 ms and an exponential of 2 ms.
std::vector<Packet> stream(std::int64_t first, std::int64_t count, std::optional<std::int64_t> modulus, double start_s = 0.0) {
  std::mt19937_64 engine(7);
  std::exponential_distribution<double> jitter(1.0 / 0.002);
  std::vector<Packet> packets;
  for (std::int64_t i = 0; i < count; ++i) {
    Packet packet;
    packet.counter = modulus ? (first + i) % *modulus : first + i;
    packet.arrival_s = start_s + 0.01 * static_cast<double>(i) + 0.001 + jitter(engine);
    packets.push_back(packet);
  }
  return packets;
}

void remove(std::vector<Packet>& packets, std::size_t from, std::size_t count) {
  const auto at = packets.begin() + static_cast<std::ptrdiff_t>(from);
  packets.erase(at, at + static_cast<std::ptrdiff_t>(count));
}

class EveryModulus : public testing::TestWithParam<std::optional<std::int64_t>> {
 protected:
  Counting counting_{.modulus = GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Packets, EveryModulus,
                         testing::Values(std::nullopt, std::int64_t{1} << 8, std::int64_t{1} << 16, std::int64_t{1} << 32));

TEST_P(EveryModulus, CountsWhatIsLostDoubledAndReorderedOverWraps) {
  const std::int64_t first = GetParam() ? *GetParam() - 50 : 1'000'000;  // the first wrap comes soon
  std::vector<Packet> packets = stream(first, 3000, GetParam());
  const std::vector<Packet> sent = packets;
  // From the back, so that places stay. A gap of 7 s is 2.7 wraps of eight bits.
  remove(packets, 2000, 700);
  std::swap(packets[1502], packets[1500]);  // 1502 before 1501 before 1500: two come after a later one
  packets.insert(packets.begin() + 1000, packets[998]);
  packets.insert(packets.begin() + 52, packets[49]);  // doubled over the wrap
  remove(packets, 10, 1);
  const PacketReport report = check_packets(packets, counting_);
  EXPECT_EQ(report.received, packets.size());
  EXPECT_EQ(report.lost, 701u);
  EXPECT_EQ(report.doubled, 2u);
  EXPECT_EQ(report.reordered, 2u);
  EXPECT_EQ(report.stray, 0u);
  ASSERT_EQ(report.segments.size(), 1u);
  const PacketSegment& segment = report.segments[0];
  ASSERT_EQ(segment.lost.size(), 2u);
  EXPECT_EQ(segment.lost[0].after, first + 9);
  EXPECT_EQ(segment.lost[0].count, 1);
  EXPECT_EQ(segment.lost[1].after, first + 1999);
  EXPECT_EQ(segment.lost[1].count, 700);
  ASSERT_EQ(segment.packets.size(), 3000u - 701u);
  std::size_t k = 0;
  for (std::size_t i = 0; i < sent.size(); ++i) {  // against what was sent
    if (i == 10 || (i >= 2000 && i < 2700)) continue;
    EXPECT_EQ(segment.packets[k].counter, first + static_cast<std::int64_t>(i));
    EXPECT_EQ(segment.packets[k].arrival_s, sent[i].arrival_s);
    ++k;
  }
}

TEST_P(EveryModulus, AStalledComputerLosesNothing) {
  std::vector<Packet> packets = stream(0, 1000, GetParam());
  for (std::size_t i = 300; i < 380; ++i) packets[i].arrival_s = 3.81 + 1e-5 * static_cast<double>(i);  // 0.8 s in one burst
  const PacketReport report = check_packets(packets, counting_);
  EXPECT_EQ(report.lost, 0u);
  EXPECT_EQ(report.stray, 0u);
  EXPECT_EQ(report.restarts(), 0u);
}

TEST_P(EveryModulus, ARestartIsANewSegment) {
  const std::int64_t first = GetParam() ? *GetParam() - 900 % *GetParam() : 5000;
  std::vector<Packet> packets = stream(GetParam() ? first % *GetParam() : first, 830, GetParam());
  const std::vector<Packet> again = stream(0, 500, GetParam(), 10.0);  // 1.7 s later
  packets.insert(packets.end(), again.begin(), again.end());
  const PacketReport report = check_packets(packets, counting_);
  ASSERT_EQ(report.segments.size(), 2u);
  EXPECT_EQ(report.segments[0].packets.size(), 830u);
  EXPECT_EQ(report.segments[1].packets.size(), 500u);
  EXPECT_EQ(report.segments[1].packets.front().counter, 0);
  EXPECT_EQ(report.segments[1].packets.back().counter, 499);
  EXPECT_EQ(report.lost, 0u);
}

TEST(Packets, AStrayCounterIsDroppedWithoutARestart) {
  std::vector<Packet> packets = stream(100, 500, std::int64_t{1} << 16);
  packets[200].counter = 45000;
  const PacketReport report = check_packets(packets, {.modulus = std::int64_t{1} << 16});
  EXPECT_EQ(report.stray, 1u);
  EXPECT_EQ(report.lost, 1u);
  EXPECT_EQ(report.restarts(), 0u);
}

// Against the truth that the generator knows, with everything happening at random.
TEST(Packets, RandomStreamsOfSixteenBitsArePutRight) {
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  for (int run = 0; run < 20; ++run) {
    const std::int64_t modulus = std::int64_t{1} << 16;
    std::vector<Packet> sent = stream(modulus - 700, 4000, modulus), packets;
    std::set<std::size_t> arrived;
    std::size_t doubled = 0;
    for (std::size_t i = 0; i < sent.size(); ++i) {
      if (i > 0 && i + 1 < sent.size() && chance(engine) < 0.05) continue;
      packets.push_back(sent[i]);
      arrived.insert(i);
      if (chance(engine) < 0.03) packets.push_back(sent[i]), ++doubled;
    }
    for (std::size_t i = 2; i + 1 < packets.size(); ++i)
      if (chance(engine) < 0.03) std::swap(packets[i], packets[i - 1]);
    const PacketReport report = check_packets(packets, {.modulus = modulus});
    EXPECT_EQ(report.lost, sent.size() - arrived.size());
    EXPECT_EQ(report.doubled, doubled);
    ASSERT_EQ(report.segments.size(), 1u);
    ASSERT_EQ(report.segments[0].packets.size(), arrived.size());
    std::size_t k = 0;
    for (const std::size_t i : arrived)
      EXPECT_EQ(report.segments[0].packets[k++].counter, modulus - 700 + static_cast<std::int64_t>(i));
  }
}

TEST(Packets, RefusesWhatIsOutOfRange) {
  const std::vector<Packet> packets = stream(0, 10, {});
  EXPECT_THROW((void)check_packets(packets, {.interval_s = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)check_packets(packets, {.modulus = 100}), std::invalid_argument);
  EXPECT_THROW((void)check_packets(packets, {.most_late = 0}), std::invalid_argument);
  EXPECT_THROW((void)check_packets(packets, {.most_delay_s = 0.0}), std::invalid_argument);
  std::vector<Packet> beyond = packets;
  beyond[3].counter = 256;
  EXPECT_THROW((void)check_packets(beyond, {.modulus = 256}), std::invalid_argument);
  std::vector<Packet> never = packets;
  never[3].arrival_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)check_packets(never, {}), std::invalid_argument);
  EXPECT_TRUE(check_packets({}, {}).segments.empty());
}

}  // namespace
}  // namespace coast::array
