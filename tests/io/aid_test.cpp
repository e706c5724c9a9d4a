// Tables of aiding sensors: what is read, what is left out and counted, what is refused.

#include "coast/io/aid.hpp"

#include <gtest/gtest.h>

#include "coast/io/writers.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

class AidFiles : public testing::Test {
 protected:
  [[nodiscard]] record::AidRecording read(const std::string& content, const std::string& keys, std::size_t values = 1) const {
    files_.put("aid.csv", content);
    const config::Node root =
        parse_yaml("aid: {file: aid.csv" + (keys.empty() ? "" : ", " + keys) + "}", files_.path("run.yaml").string());
    const std::vector<std::string_view> names = values == 1 ? std::vector<std::string_view>{"speed_mps"}
                                                            : std::vector<std::string_view>{"lat_deg", "lon_deg", "height_m"};
    const std::vector<std::string_view> sds =
        values == 1 ? std::vector<std::string_view>{"speed_sd_mps"} : std::vector<std::string_view>{"sdn_m", "sde_m", "sdd_m"};
    return read_aid(AidFileOptions::from(root.at("aid"), names, sds));
  }
  [[nodiscard]] std::string refusal(const std::string& content, const std::string& keys, std::size_t values = 1) const {
    try {
      static_cast<void>(read(content, keys, values));
    } catch (const InputError& e) {
      return e.what();
    }
    return "not refused";
  }

  test::Files files_;
};

TEST_F(AidFiles, DefaultColumnsWithAndWithoutSigmas) {
  const record::AidRecording without = read("time_s,speed_mps\n100.0,1.5\n100.1,1.6\n", "gps_week: 2374");
  ASSERT_EQ(without.samples.size(), 2U);
  EXPECT_EQ(without.samples[1].value, Eigen::Vector3d(1.6, 0.0, 0.0));
  EXPECT_EQ(without.samples[1].sd, Eigen::Vector3d::Zero());
  EXPECT_EQ(without.samples[0].t, geo::GpsTime::from_week(2374, 100.0));
  const record::AidRecording with = read("gps_week,sow_s,speed_mps,speed_sd_mps\n2374,100.0,1.5,0.2\n", "");
  EXPECT_EQ(with.samples[0].sd.x(), 0.2);
}

TEST_F(AidFiles, MappedColumnsOfThreeValues) {
  const record::AidRecording points = read("1 46.5 6.5 400 0.1 0.2 0.3\n5 46.6 6.6 401 0.1 0.2 0.4\n",
                                           "columns: {time: 1, value: [2, 3, 4], sd: [5, 6, 7]}, gps_week: 2374", 3);
  ASSERT_EQ(points.samples.size(), 2U);
  EXPECT_EQ(points.samples[1].value, Eigen::Vector3d(46.6, 6.6, 401.0));
  EXPECT_EQ(points.samples[1].sd, Eigen::Vector3d(0.1, 0.2, 0.4));
}

TEST_F(AidFiles, RowsThatSayNothingAreCounted) {
  const record::AidRecording rows = read("time_s,speed_mps\n100.0,1.5\n100.1,nan\n100.0,1.6\n100.2,1.7\n", "gps_week: 2374");
  ASSERT_EQ(rows.samples.size(), 2U);
  ASSERT_EQ(rows.events.size(), 2U);
  EXPECT_EQ(rows.events[0].kind, "aid_nan");
  EXPECT_EQ(rows.events[1].kind, "aid_time");
}

TEST_F(AidFiles, SpoiledFilesAreRefusedWithTheirLine) {
  const std::string week = "gps_week: 2374";
  EXPECT_NE(refusal("", week).find("aid.csv: the file is empty"), std::string::npos);
  EXPECT_NE(refusal("time_s,v\n1,2\n", week).find("no column named \"speed_mps\""), std::string::npos);
  EXPECT_NE(refusal("time_s,speed_mps\n1,2\n2,x\n", week).find("aid.csv:3: \"x\""), std::string::npos);
  EXPECT_NE(refusal("time_s,speed_mps\n1,nan\n", week).find("no row that can be used"), std::string::npos);
  EXPECT_NE(refusal("time_s,speed_mps,speed_sd_mps\n1,2,0\n", week).find("aid.csv:2: a standard deviation of zero"),
            std::string::npos);
  EXPECT_NE(refusal("time_s,speed_mps\n1,2\n", "").find("without a GPS week"), std::string::npos);
  EXPECT_NE(refusal("1,2,3\n", "columns: {time: 1, value: [2, 3]}, gps_week: 2374").find("run.yaml:1"), std::string::npos);
}

TEST_F(AidFiles, WrittenRowsReadBack) {
  record::AidRecording rows;
  for (int i = 0; i < 3; ++i)
    rows.samples.push_back({geo::GpsTime::from_week(2374, 604799.5 + 0.5 * i), {1.25 * i, 0.0, 0.0}, Eigen::Vector3d::Zero()});
  write_aid_csv(files_.path("written.csv"), rows, "speed_mps");
  const record::AidRecording back = read(files_.get("written.csv"), "");
  ASSERT_EQ(back.samples.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.samples[i].t, rows.samples[i].t);
    EXPECT_EQ(back.samples[i].value.x(), rows.samples[i].value.x());
  }
}

}  // namespace
}  // namespace coast::io
