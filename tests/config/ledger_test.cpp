#include <gtest/gtest.h>

#include "coast/config/node.hpp"
#include "config/sample.hpp"

namespace coast::config {
namespace {

void ask_everything(const Node& root) {
  const Node imu = root.at("imu");
  for (const std::string& key : imu.keys()) (void)imu.at(key);
  (void)root.at("start");
  (void)root.find("empty");
  for (const Node& outage : root.at("outages").items()) (void)outage.at("start_s");
}

TEST(Ledger, AcceptsATreeThatWasReadWhole) {
  const Node root = sample();
  ask_everything(root);
  EXPECT_NO_THROW(root.refuse_unasked());
}

TEST(Ledger, NamesTheNearestKeyThatSomebodyAskedFor) {
  const Node root = sample();
  ask_everything(root);
  EXPECT_NO_THROW(root.refuse_unasked());

  const Node other = sample();
  const Node imu = other.at("imu");
  (void)imu.number("rate_hzz", 1.0);  // the run knows this key; the file spells another
  (void)imu.find("file");
  EXPECT_EQ(message_of([&] { other.refuse_unasked(); }),
            "runs/run.yaml:3: imu.rate_hz: unknown key, expected 'rate_hzz' (the nearest known key). Correct or remove it.");
}

TEST(Ledger, ListsTheKnownKeysWhereNoneIsNear) {
  const Node root = sample();
  (void)root.find("gnss");
  (void)root.find("reference");
  EXPECT_EQ(message_of([&] { root.refuse_unasked(); }),
            "runs/run.yaml:1: imu: unknown key, expected one of gnss, reference. Correct or remove it.");
}

TEST(Ledger, LooksInsideListsAndMapsThatWereFoundButNotRead) {
  const Node root = sample();
  const Node imu = root.at("imu");
  for (const std::string& key : imu.keys()) (void)imu.at(key);
  (void)root.at("start");
  (void)root.find("empty");
  (void)root.at("outages").items();
  EXPECT_EQ(message_of([&] { root.refuse_unasked(); }),
            "runs/run.yaml:9: outages[0].start_s: unknown key, expected nothing: this run uses no key here. "
            "Correct or remove it.");
}

TEST(Resolved, SaysWhereEachValueCameFrom) {
  const Node root = sample("/r/run.yaml");
  ask_everything(root);
  const Node imu = root.at("imu");
  (void)imu.at("file").path();
  (void)imu.number("gps_week_offset", 0.1);
  (void)imu.text("format", "a b");
  (void)root.section("vehicle").vector3("nhc_point_m", {0, -0.5, 1e-9});
  (void)root.section("unused");
  root.note_estimated("start", "{time_s: 12.5}");
  root.section("vehicle").note_estimated("yaw_deg", "1.25");
  EXPECT_EQ(root.resolved_yaml(),
            "imu:\n"
            "  file: /r/data/imu.csv  # /r/run.yaml:2\n"
            "  rate_hz: 100  # /r/run.yaml:3\n"
            "  lever_arm_m: [1, 2.5, -1e-3]  # /r/run.yaml:4\n"
            "  axes: [x, y]  # /r/run.yaml:5\n"
            "  filtered: false  # /r/run.yaml:6\n"
            "  format: \"a b\"  # default\n"
            "  gps_week_offset: 0.1  # default\n"
            "start: auto  # /r/run.yaml:7\n"
            "outages:\n"
            "  - start_s: 10.5  # /r/run.yaml:9\n"
            "empty: null  # /r/run.yaml:10\n"
            "vehicle:\n"
            "  nhc_point_m: [0, -0.5, 1e-09]  # default\n"
            "  # yaw_deg: 1.25  # estimated\n"
            "# start: {time_s: 12.5}  # estimated\n");
}

TEST(Resolved, EstimateStandsBesideADefault) {
  const Node root;
  (void)root.number("time_offset_s", 0.0);
  root.note_estimated("time_offset_s", "0.0123");
  EXPECT_EQ(root.resolved_yaml(), "time_offset_s: 0  # default\n# time_offset_s: 0.0123  # estimated\n");
}

TEST(Resolved, PathFromTheDataFolderStaysPortable) {
  TreeBuilder b("/r/run.yaml");
  b.add_scalar(b.root_map(1), "file", "${COAST_DATA}/imu.csv", 1);
  const Node root = b.finish();
  setenv("COAST_DATA", "/recordings", 0);
  (void)root.at("file").path();
  EXPECT_EQ(root.resolved_yaml(), "file: \"${COAST_DATA}/imu.csv\"  # /r/run.yaml:1\n");
}

}  // namespace
}  // namespace coast::config
