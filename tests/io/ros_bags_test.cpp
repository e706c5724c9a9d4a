// Bags of ROS of known content, in each container.

#include <bzlib.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include <sstream>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/contents.hpp"
#include "coast/io/writers.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/ros_bags.hpp"

namespace coast::io {
namespace {

using test::BagEntry;
using test::BagTopicName;
using test::Bytes;
using test::Files;
using test::refusal;
using test::RosBytes;
using enum test::RosBytes::As;

constexpr std::int64_t kBagStart = 1'700'000'000'000'000'000;  // ns; 2023-11-14 22:13:20 UTC
const geo::GpsTime kBagGpsStart = geo::GpsTime::from_utc({2023, 11, 14, 22, 13, 20.0});
const std::vector<BagTopicName> kBagTopics = {
    {"/imu/data", "sensor_msgs/Imu"}, {"/fix", "sensor_msgs/NavSatFix"}, {"/camera/imu", "sensor_msgs/Imu"}};

std::string bz2(const std::string& content) {
  std::string packed(content.size() + 1000, '\0');
  auto size = static_cast<unsigned>(packed.size());
  std::string copy = content;
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, copy.data(), static_cast<unsigned>(copy.size()), 9, 0, 0), BZ_OK);
  packed.resize(size);
  return packed;
}

std::string lz4(const std::string& content) {
  std::string packed(LZ4F_compressFrameBound(content.size(), nullptr), '\0');
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), content.data(), content.size(), nullptr));
  return packed;
}

std::string zstd(const std::string& content) {
  std::string packed(ZSTD_compressBound(content.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 3));
  return packed;
}

std::string packed_as(const std::string& compression, const std::string& content) {
  return compression == "bz2"    ? bz2(content)
         : compression == "lz4"  ? lz4(content)
         : compression == "zstd" ? zstd(content)
                                 : content;
}

/// 100 Hz of an IMU and 5 Hz of positions; stamps are 3 ms before the log's times.
std::vector<BagEntry> drive(RosBytes::As as, int from, int to) {
  std::vector<BagEntry> entries;
  for (int i = from; i < to; ++i) {
    const std::int64_t stamp = kBagStart + 10'000'000LL * i + 123;
    entries.push_back({0, stamp + 3'000'000, test::ros_imu(as, stamp, i)});
    if (i % 20 == 0) entries.push_back({1, stamp + 3'000'000, test::ros_fix(as, stamp)});
  }
  return entries;
}

std::string rosbag_content(const std::vector<BagEntry>& entries) {
  std::string content;
  for (const BagEntry& entry : entries) content += test::rosbag_message(entry);
  return content;
}

std::string rosbag(const std::string& compression, int chunks = 4) {
  std::string bag = test::rosbag_head(1);
  for (int k = 0; k < chunks; ++k) {
    std::string content = rosbag_content(drive(kRos1, 50 * k, 50 * k + 50));
    if (k == 0) content = test::rosbag_connection(0, kBagTopics[0]) + test::rosbag_connection(1, kBagTopics[1]) + content;
    bag += test::rosbag_chunk(compression, packed_as(compression, content), content.size());
  }
  return bag;
}

std::string mcap_definitions(const std::string& encoding = "cdr") {
  return test::mcap_schema(1, "sensor_msgs/msg/Imu") + test::mcap_schema(2, "sensor_msgs/msg/NavSatFix") +
         test::mcap_channel(0, 1, "/imu/data", encoding) + test::mcap_channel(1, 2, "/fix", encoding);
}

std::string mcap_content(const std::vector<BagEntry>& entries) {
  std::string content;
  for (const BagEntry& entry : entries) content += test::mcap_message(entry);
  return content;
}

std::string mcap(const std::string& compression, RosBytes::As as = kCdrLittle, int chunks = 4) {
  std::string bag = test::mcap_head();
  for (int k = 0; k < chunks; ++k) {
    std::string content = mcap_content(drive(as, 50 * k, 50 * k + 50));
    if (k == 0) content = mcap_definitions(as == kRos1 ? "ros1" : "cdr") + content;
    bag += test::mcap_chunk(content, compression, packed_as(compression, content));
  }
  return bag + test::mcap_end(bag);
}

/// What drive() says, of so many samples.
void expect_drive(const Files& files, const std::string& name, std::size_t samples = 200) {
  const auto imu = files.imu(name);
  ASSERT_EQ(imu.samples.size(), samples) << name;
  EXPECT_NEAR(imu.rate_hz, 100.0, 1e-9);
  for (std::size_t i = 1; i < samples; i += 7) {
    const record::ImuSample& s = imu.samples[i];
    const double number = static_cast<double>((s.t - kBagGpsStart) * 100.0);
    EXPECT_EQ(s.t.nanoseconds(), kBagGpsStart.nanoseconds() + 10'000'000LL * std::llround(number) + 123);
    if (s.dt > 0.015) continue;  // after a gap, and bridged
    EXPECT_LT((s.dtheta / s.dt - Eigen::Vector3d(std::round(number), 0.5, -0.25)).norm(), 1e-9);
    EXPECT_LT((s.dv / s.dt - Eigen::Vector3d(0.125, -0.5, 9.75)).norm(), 1e-12);
  }
  const auto gnss = files.gnss(name);
  ASSERT_FALSE(gnss.fixes.empty());
  const record::GnssFix& fix = gnss.fixes[0];
  EXPECT_EQ(fix.t.nanoseconds(), kBagGpsStart.nanoseconds() + 123);
  const geo::Geodetic place{47.5 * geo::kDegree, 8.25 * geo::kDegree, 512.5};
  EXPECT_LT((fix.r_ea_e - geo::ecef_from_geodetic(place)).norm(), 1e-8);
  Eigen::Matrix3d ned;
  ned << 1.0, 0.5, 0.125, 0.5, 4.0, -0.25, 0.125, -0.25, 9.0;
  EXPECT_LT((fix.position_cov_n - ned).norm(), 1e-12);
  EXPECT_EQ(fix.quality, record::FixQuality::kSingle);
  EXPECT_FALSE(fix.satellites);
  EXPECT_FALSE(fix.velocity);
}

TEST(RosBag, OfRos1IsReadWithEachCompression) {
  const Files files;
  for (const char* compression : {"none", "bz2", "lz4"}) {
    files.put("drive.bag", rosbag(compression));
    expect_drive(files, "drive.bag");
  }
  files.put_gzip("drive.bag.gz", rosbag("none"));
  expect_drive(files, "drive.bag.gz");
}

TEST(RosBag, AsMcapIsReadWithEachCompressionAndEncoding) {
  const Files files;
  for (const char* compression : {"", "lz4", "zstd"})
    for (const auto as : {kCdrLittle, kCdrBig, kRos1}) {
      files.put("drive.mcap", mcap(compression, as));
      expect_drive(files, "drive.mcap");
      EXPECT_TRUE(files.imu("drive.mcap").events.empty()) << files.imu("drive.mcap").events.front().text;
    }
}

TEST(RosBag, AsMcapIsReadWithoutChunksAndWithoutItsEnd) {
  const Files files;
  const std::string bag = test::mcap_head() + mcap_definitions() + mcap_content(drive(kCdrLittle, 0, 200));
  files.put("drive.mcap", bag);
  expect_drive(files, "drive.mcap");
  EXPECT_EQ(test::count_of(files.imu("drive.mcap").events, "bag_not_closed"), 1);
  files.put("drive.mcap", bag.substr(0, bag.size() - 100));
  expect_drive(files, "drive.mcap", 199);
  EXPECT_EQ(test::count_of(files.imu("drive.mcap").events, "bag_cut_off"), 1);
  // Kinds of records that later versions may add, and attachments, are stepped over.
  std::string more = bag + test::mcap_record(0x99, "anything") + test::mcap_record(9, std::string(200000, 'x'));
  files.put("drive.mcap", more + test::mcap_end(more));
  expect_drive(files, "drive.mcap");
  EXPECT_TRUE(files.imu("drive.mcap").events.empty());
}

TEST(RosBag, WithDamageLosesTheChunk) {
  const Files files;
  for (const bool mcap_file : {false, true})
    for (const std::string& compression :
         mcap_file ? std::vector<std::string>{"", "lz4", "zstd"} : std::vector<std::string>{"bz2", "lz4"}) {
      std::string bag = mcap_file ? mcap(compression) : rosbag(compression);
      const std::string third = packed_as(
          compression, mcap_file ? mcap_content(drive(kCdrLittle, 100, 150)) : rosbag_content(drive(kRos1, 100, 150)));
      const std::size_t at = bag.find(third);
      ASSERT_NE(at, std::string::npos);
      for (std::size_t i = 0; i < 20; ++i) bag[at + third.size() / 2 + i] = static_cast<char>(~bag[at + third.size() / 2 + i]);
      files.put("drive.bin", bag);
      expect_drive(files, "drive.bin", 150);
      const auto events = files.imu("drive.bin").events;
      EXPECT_EQ(test::count_of(events, "bag_chunk_damaged"), 1) << compression;
      EXPECT_EQ(test::count_of(events, "bag_checksum"), mcap_file ? 1 : 0);
      EXPECT_EQ(test::count_of(events, "imu_gap"), 1);
    }
}

TEST(RosBag, OfRos1ThatWasNotClosedIsRead) {
  const Files files;
  const std::string bag = rosbag("none", 2);
  const std::string zero_index = test::rosbag_head(0) + bag.substr(test::rosbag_head(0).size());
  files.put("drive.bag.active", zero_index);
  expect_drive(files, "drive.bag.active", 100);
  EXPECT_EQ(test::count_of(files.imu("drive.bag.active").events, "bag_not_closed"), 1);
  // A crash: the last chunk has no size yet, and its records follow.
  const std::string third = rosbag_content(drive(kRos1, 100, 150));
  files.put("drive.bag.active", zero_index + test::rosbag_chunk("none", "", 0) + third.substr(0, third.size() - 10));
  expect_drive(files, "drive.bag.active", 149);
  // The copy was cut off in a chunk without compression: what is there is read.
  files.put("cut.bag", bag.substr(0, bag.size() - 200));
  expect_drive(files, "cut.bag", 99);
  EXPECT_EQ(test::count_of(files.imu("cut.bag").events, "bag_cut_off"), 1);
  // What is no record ends the reading.
  files.put("garbage.bag", bag + std::string(5000, '\xff'));
  expect_drive(files, "garbage.bag", 100);
  EXPECT_EQ(test::count_of(files.imu("garbage.bag").events, "bag_garbage"), 1);
}

/// A database as rosbag2 makes it.
class Database {
 public:
  explicit Database(const std::filesystem::path& path) {
    std::filesystem::remove(path);
    EXPECT_EQ(sqlite3_open(path.c_str(), &base_), SQLITE_OK);
    run("BEGIN");
    run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT "
        "NULL, "
        "offered_qos_profiles TEXT NOT NULL)");
    run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT "
        "NULL)");
    run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  ~Database() {
    run("COMMIT");
    sqlite3_close(base_);
  }
  void run(const std::string& sql) const { EXPECT_EQ(sqlite3_exec(base_, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK); }
  void topic(int id, const std::string& name, const std::string& type, const std::string& format = "cdr") const {
    run("INSERT INTO topics VALUES(" + std::to_string(id) + ",'" + name + "','" + type + "','" + format + "','')");
  }
  void message(const BagEntry& entry) const {
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(base_, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?,?,?)", -1, &statement, nullptr);
    sqlite3_bind_int(statement, 1, entry.topic);
    sqlite3_bind_int64(statement, 2, entry.log_ns);
    sqlite3_bind_blob(statement, 3, entry.bytes.data(), static_cast<int>(entry.bytes.size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(statement), SQLITE_DONE);
    sqlite3_finalize(statement);
  }

 private:
  sqlite3* base_ = nullptr;
};

TEST(RosBag, InSqliteIsRead) {
  const Files files;
  for (const bool compressed : {true, false}) {
    {
      const Database base(files.path("drive.db3"));
      base.topic(0, "/imu/data", "sensor_msgs/msg/Imu");
      base.topic(1, "/fix", "sensor_msgs/msg/NavSatFix");
      base.topic(2, "/image", "sensor_msgs/msg/Image");
      base.message({2, kBagStart, std::string(100000, 'x')});
      for (BagEntry entry : drive(kCdrLittle, 0, 200)) {
        if (compressed) entry.bytes = zstd(entry.bytes);
        base.message(entry);
      }
      base.message({7, kBagStart, "no such topic"});
    }
    expect_drive(files, "drive.db3");
    EXPECT_EQ(test::count_of(files.imu("drive.db3").events, "bag_undefined"), 1);
  }
  // Pages that are not there: what is before them is read.
  const std::string bytes = files.get("drive.db3");
  files.put("cut.db3", bytes.substr(0, bytes.size() - std::size_t{12} * 4096));
  const auto cut = files.imu("cut.db3");
  EXPECT_GT(cut.samples.size(), 10U);
  EXPECT_LT(cut.samples.size(), 200U);
  EXPECT_EQ(test::count_of(cut.events, "bag_cut_off"), 1);
  {
    const Database base(files.path("empty.db3"));
    base.run("DROP TABLE messages");
  }
  EXPECT_NE(refusal([&] { (void)files.imu("empty.db3"); }).find("without the table `messages`"), std::string::npos);
}

TEST(RosBag, WithSeveralTopicsAsksForOne) {
  const Files files;
  std::string content = test::mcap_schema(1, "sensor_msgs/msg/Imu") + test::mcap_channel(0, 1, "/imu/data") +
                        test::mcap_channel(2, 1, "/camera/imu");
  for (int i = 0; i < 10; ++i) {
    const std::int64_t stamp = kBagStart + 10'000'000LL * i;
    content += test::mcap_message({0, stamp, test::ros_imu(kCdrLittle, stamp, i)});
    if (i < 4) content += test::mcap_message({2, stamp, test::ros_imu(kCdrLittle, stamp, -i)});
  }
  files.put("drive.mcap", test::mcap_head() + content);
  const std::string asked = refusal([&] { (void)files.imu("drive.mcap"); });
  EXPECT_NE(asked.find("2 topics of sensor_msgs/Imu, expected one of /camera/imu (4 messages), /imu/data (10 messages)"),
            std::string::npos)
      << asked;
  EXPECT_NE(asked.find("`imu: {file: drive.mcap, topic: /imu/data}`"), std::string::npos) << asked;
  EXPECT_EQ(files.imu("drive.mcap", "topic: /camera/imu").samples.size(), 4U);
  EXPECT_EQ(files.imu("drive.mcap", "topic: /imu/data").samples.size(), 10U);
  EXPECT_NE(refusal([&] { (void)files.imu("drive.mcap", "topic: /none"); }).find("no topic /none"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)files.gnss("drive.mcap"); }).find("a bag without messages of sensor_msgs/NavSatFix"),
            std::string::npos);
  const auto contents = read_contents(files.path("drive.mcap"));
  ASSERT_EQ(contents.messages.size(), 2U);
  EXPECT_EQ(contents.messages[0].name, "/imu/data (sensor_msgs/Imu)");
  EXPECT_EQ(contents.messages[0].number, 10);
}

std::string imu_mcap(const std::vector<std::string>& messages) {
  std::string content = test::mcap_head() + mcap_definitions();
  for (std::size_t i = 0; i < messages.size(); ++i)
    content += test::mcap_message({0, kBagStart + 10'000'000LL * static_cast<std::int64_t>(i), messages[i]});
  return content;
}

TEST(RosBag, CountsMessagesOfAnImuThatCannotBeUsed) {
  const Files files;
  std::vector<std::string> messages;
  for (int i = 0; i < 20; ++i) messages.push_back(test::ros_imu(kCdrLittle, kBagStart + 10'000'000LL * i, 0.25 * i));
  messages[3] = test::ros_imu(kCdrLittle, kBagStart + 30'000'000, 1.0, -1.0);
  messages[5] = test::ros_imu(kCdrLittle, 0, 1.0);
  messages[7] = messages[7].substr(0, 100);
  messages[9] = test::ros_imu(kCdrLittle, kBagStart + 90'000'000, std::nan(""));
  messages[11] = test::ros_imu(kCdrLittle, 5'000'000'000, 1.0);
  messages[13] += std::string(50, 'x');
  files.put("drive.mcap", imu_mcap(messages));
  const auto imu = files.imu("drive.mcap", "units: {accel: g}");
  EXPECT_EQ(imu.samples.size(), 15U);
  EXPECT_EQ(imu.samples[4].t.nanoseconds(), kBagGpsStart.nanoseconds() + 50'000'000);  // the log's time
  EXPECT_NEAR(imu.samples[1].dv.z() / imu.samples[1].dt, 9.75 * 9.80665, 1e-9);
  for (const char* kind : {"bag_sensor_missing", "bag_stamp_not_set", "nan_row", "bag_stamp_impossible"})
    EXPECT_EQ(test::count_of(imu.events, kind), 1) << kind;
  EXPECT_EQ(test::count_of(imu.events, "bag_message_undecoded"), 2);
}

TEST(RosBag, WithTheTimesOfASimulationCountsFromTheStatedWeek) {
  const Files files;
  std::vector<std::string> messages;
  for (int i = 0; i < 20; ++i) messages.push_back(test::ros_imu(kCdrLittle, 5'000'000'000 + 10'000'000LL * i, 0.0));
  files.put("drive.mcap", imu_mcap(messages));
  const std::string refused = refusal([&] { (void)files.imu("drive.mcap"); });
  EXPECT_NE(refused.find("20 with stamps outside the years 2000 to 2100"), std::string::npos) << refused;
  const auto imu = files.imu("drive.mcap", "gps_week: 2300, time: {kind: elapsed, offset_s: 100}");
  EXPECT_EQ(imu.samples[1].t, geo::GpsTime::from_week(2300, 105.01));
}

TEST(RosBag, PositionsHaveTheirCovarianceByItsKind) {
  const Files files;
  const auto put = [&](const test::RosFixValues& values) {
    files.put("fix.mcap", test::mcap_head() + mcap_definitions() +
                              test::mcap_message({1, kBagStart, test::ros_fix(kCdrLittle, kBagStart, values)}));
  };
  put({.status = 2, .kind = 2});
  const auto fix = files.gnss("fix.mcap").fixes[0];
  EXPECT_LT((fix.position_cov_n - Eigen::Matrix3d(Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal())).norm(), 1e-12);
  EXPECT_EQ(fix.quality, record::FixQuality::kDgps);
  put({.kind = 0});
  EXPECT_NE(refusal([&] {
              (void)files.gnss("fix.mcap");
            }).find("1 without accuracy, expected at least one fix. Give `sd_m: [n, e, d]`"),
            std::string::npos);
  EXPECT_EQ(files.gnss("fix.mcap", "sd_m: [1, 1, 2]").fixes[0].position_cov_n(2, 2), 4.0);
  EXPECT_EQ(files.gnss("fix.mcap", "sd_m: [1, 1, 2], time: {offset_s: -18}").fixes[0].t, kBagGpsStart - 18.0);
  for (const test::RosFixValues& bad : std::vector<test::RosFixValues>{{.status = -1},
                                                                       {.status = -2},
                                                                       {.latitude = std::nan("")},
                                                                       {.height = 1e9},
                                                                       {.covariance = std::vector<double>(9, 1.0)},
                                                                       {.kind = 9}}) {
    put(bad);
    EXPECT_NE(refusal([&] { (void)files.gnss("fix.mcap"); }), "");
  }
}

TEST(RosBag, PosesAreAReferenceOnceTheirOriginIsStated) {
  const Files files;
  // A quarter turn to the left about up: forward, which is east without, is north.
  const double half = std::sqrt(0.5);
  const std::string twist_and_covariance(8 * 42, '\0');
  const std::vector<std::string> types = {"geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped",
                                          "geometry_msgs/msg/TransformStamped", "nav_msgs/msg/Odometry"};
  for (std::size_t k = 0; k < types.size(); ++k) {
    std::string content = test::mcap_head() + test::mcap_schema(1, types[k]) + test::mcap_channel(4, 1, "/pose");
    for (int i = 0; i < 3; ++i) {
      RosBytes b(kCdrLittle);
      b.header(kBagStart + 1'000'000'000LL * i, "map");
      if (k >= 2) b.text("base_link");
      b.numbers({100.0, 200.0 + i, 30.0}).numbers({0.0, 0.0, half, half});
      if (k == 1 || k == 3) b.numbers(std::vector<double>(36, 0.0));
      if (k == 3) b.numbers(std::vector<double>(42, 0.0));
      content += test::mcap_message({4, kBagStart, b.str()});
    }
    files.put("pose.mcap", content);
    EXPECT_NE(refusal([&] { (void)files.reference("pose.mcap"); }).find("State `frame: enu`"), std::string::npos);
    const auto trajectory = files.reference("pose.mcap", "frame: enu, origin_deg_m: [47.5, 8.25, 500], body_axes: flu");
    ASSERT_EQ(trajectory.states.size(), 3U) << types[k];
    EXPECT_TRUE(trajectory.has_attitude);
    EXPECT_FALSE(trajectory.has_velocity);
    const geo::Geodetic origin{47.5 * geo::kDegree, 8.25 * geo::kDegree, 500.0};
    const Eigen::Matrix3d C_n_e = geo::C_n_e(origin);
    const Eigen::Vector3d r_e = geo::ecef_from_geodetic(origin) + C_n_e * Eigen::Vector3d(201.0, 100.0, -30.0);
    EXPECT_LT((trajectory.states[1].r_eb_e - r_e).norm(), 1e-6);
    EXPECT_EQ(trajectory.states[1].t, kBagGpsStart + 1.0);
    // Forward is north, right east, down down: the local axes themselves.
    EXPECT_LT((trajectory.states[1].q_b_e.toRotationMatrix() - C_n_e).norm(), 1e-12);
  }
}

TEST(RosBag, ThatCannotBeReadIsRefused) {
  const Files files;
  const auto imu = [&](const std::string& content, const std::string& keys) {
    files.put("drive.bin", content);
    return refusal([&] { (void)files.imu("drive.bin", keys); });
  };
  EXPECT_NE(imu("text", "format: rosbag").find("no \"#ROSBAG\""), std::string::npos);
  EXPECT_NE(imu("text", "format: mcap").find("no \"MCAP\""), std::string::npos);
  EXPECT_NE(imu("text", "format: rosbag2").find("no \"SQLite format 3\""), std::string::npos);
  EXPECT_NE(imu("#ROSBAG V1.2\nxx", "").find("\"ROSBAG V1.2\", expected \"ROSBAG V2.0\""), std::string::npos);
  EXPECT_NE(imu("\x89MCAP1\r\n", "").find("no \"MCAP\" of version 0"), std::string::npos);
  EXPECT_NE(imu("#ROSBAG V2.0\n", "").find("a bag without messages of sensor_msgs/Imu"), std::string::npos);
  EXPECT_NE(imu("#ROSBAG V2.0\n" + test::rosbag_record({test::rosbag_op(3), "encryptor=AES"}, ""), "").find("encrypted by AES"),
            std::string::npos);
  EXPECT_NE(imu(std::string("SQLite format 3\0", 16) + "rest", "").find("cannot read"), std::string::npos);
  EXPECT_NE(imu(zstd("anything"), "").find("this is a Zstandard-compressed file"), std::string::npos);
  files.put_gzip("drive.db3.gz", std::string("SQLite format 3\0", 16));
  EXPECT_NE(refusal([&] { (void)files.imu("drive.db3.gz"); }).find("a gzip-compressed database"), std::string::npos);
}

TEST(RosBag, OfAnotherWriterHasItsNumbers) {
  const Files files;
  const auto lines = test::lines_of_script("bag_files.py", files.path(""));
  if (lines.empty()) GTEST_SKIP() << "no python3 here";
  for (const char* name : {"drive.bag", "drive-bz2.bag", "drive.mcap", "drive.db3"}) {
    const auto imu = files.imu(name);
    const auto gnss = files.gnss(name);
    std::size_t samples = 0, fixes = 0;
    for (const std::string& line : lines) {
      std::istringstream fields(line);
      std::string kind;
      std::int64_t stamp = 0;
      std::vector<double> v;
      fields >> kind >> stamp;
      for (double value = 0.0; fields >> value;) v.push_back(value);
      const geo::GpsTime t = geo::GpsTime::from_nanoseconds(kBagGpsStart.nanoseconds() + stamp - kBagStart);
      if (kind == "imu") {
        ASSERT_LT(samples, imu.samples.size()) << name;
        const record::ImuSample& s = imu.samples[samples++];
        ASSERT_EQ(s.t, t);
        ASSERT_EQ((Eigen::Vector3d(v[0], v[1], v[2]) * s.dt - s.dtheta).norm(), 0.0);
        ASSERT_EQ((Eigen::Vector3d(v[3], v[4], v[5]) * s.dt - s.dv).norm(), 0.0);
      } else {
        ASSERT_LT(fixes, gnss.fixes.size()) << name;
        const record::GnssFix& fix = gnss.fixes[fixes++];
        ASSERT_EQ(fix.t, t);
        const geo::Geodetic place{v[0] * geo::kDegree, v[1] * geo::kDegree, v[2]};
        ASSERT_LT((fix.r_ea_e - geo::ecef_from_geodetic(place)).norm(), 1e-8);
        const std::vector<double> cov(v.begin() + 3, v.end());  // east, north, up by rows
        Eigen::Matrix3d ned;
        ned << cov[4], cov[3], -cov[5], cov[1], cov[0], -cov[2], -cov[7], -cov[6], cov[8];
        ASSERT_LT((fix.position_cov_n - ned).norm(), 1e-15);
      }
    }
    EXPECT_EQ(samples, imu.samples.size()) << name;
    EXPECT_EQ(fixes, gnss.fixes.size()) << name;
    EXPECT_EQ(samples, 500U);
    EXPECT_EQ(fixes, 10U);
  }
}

/// A recording of an IMU and of positions, with numbers that have all digits.
void some_recording(record::ImuRecording& imu, record::GnssRecording& gnss) {
  for (int i = 0; i < 20000; ++i) {
    const double x = std::sin(0.37 * i);
    imu.samples.push_back(
        {kBagGpsStart + 0.005 * i, 0.005, Eigen::Vector3d(x, 2.0 * x, -x) / 300.0, Eigen::Vector3d(x, 0.1, 9.7) * 0.005});
    if (i % 200 != 0) continue;
    record::GnssFix fix;
    fix.t = kBagGpsStart + 0.005 * i + 0.001;
    fix.r_ea_e = geo::ecef_from_geodetic({0.8 + 1e-7 * x, 0.1, 300.0 + x});
    fix.position_cov_n << 1.0, 0.1, 0.2, 0.1, 2.0, -0.3, 0.2, -0.3, 3.0;
    fix.quality = record::FixQuality::kFixed;
    gnss.fixes.push_back(fix);
  }
}

TEST(McapWriter, WritesWhatTheReaderReturns) {
  const Files files;
  record::ImuRecording imu;
  record::GnssRecording gnss;
  some_recording(imu, gnss);
  write_mcap(files.path("drive.mcap"), &imu, &gnss);
  const auto imu_again = files.imu("drive.mcap", "topic: /imu");
  ASSERT_EQ(imu_again.samples.size(), imu.samples.size());
  EXPECT_TRUE(imu_again.events.empty());
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    const record::ImuSample &a = imu.samples[i], &b = imu_again.samples[i];
    ASSERT_EQ(a.t, b.t);
    // The file has the rates; the interval of b is from stamp to stamp, the same ns.
    ASSERT_EQ(b.dt, 0.005);
    ASSERT_EQ((a.dtheta / a.dt * 0.005 - b.dtheta).norm(), 0.0);
    ASSERT_EQ((a.dv / a.dt * 0.005 - b.dv).norm(), 0.0);
  }
  const auto gnss_again = files.gnss("drive.mcap");
  ASSERT_EQ(gnss_again.fixes.size(), gnss.fixes.size());
  for (std::size_t i = 0; i < gnss.fixes.size(); ++i) {
    ASSERT_EQ(gnss_again.fixes[i].t, gnss.fixes[i].t);
    // Through degrees: rounding at 180 deg is 3e-14 deg, 3 nm.
    ASSERT_LT((gnss_again.fixes[i].r_ea_e - gnss.fixes[i].r_ea_e).norm(), 1e-8);
    ASSERT_EQ(gnss_again.fixes[i].position_cov_n, gnss.fixes[i].position_cov_n);
  }
  const auto contents = read_contents(files.path("drive.mcap"));
  EXPECT_EQ(contents.messages.size(), 2U);
  write_mcap(files.path("gnss.mcap"), nullptr, &gnss);
  EXPECT_EQ(files.gnss("gnss.mcap").fixes.size(), gnss.fixes.size());
  EXPECT_NE(refusal([&] { (void)files.imu("gnss.mcap"); }), "");
}

}  // namespace
}  // namespace coast::io
