#include "coast/config/node.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "config/sample.hpp"

namespace coast::config {
namespace {

TEST(Node, ReadsScalarsAndLists) {
  const Node root = sample();
  const Node imu = root.at("imu");
  EXPECT_TRUE(imu.is_map());
  EXPECT_EQ(imu.at("rate_hz").number(), 100.0);
  EXPECT_EQ(imu.at("rate_hz").integer(), 100);
  EXPECT_EQ(imu.at("rate_hz").text(), "100");
  EXPECT_EQ(imu.at("lever_arm_m").vector3(), Eigen::Vector3d(1, 2.5, -1e-3));
  EXPECT_EQ(imu.at("lever_arm_m").numbers(), (std::vector<double>{1, 2.5, -1e-3}));
  EXPECT_FALSE(imu.at("filtered").flag());
  EXPECT_EQ(imu.keys(), (std::vector<std::string>{"file", "rate_hz", "lever_arm_m", "axes", "filtered"}));
  ASSERT_EQ(root.at("outages").items().size(), 1U);
  EXPECT_EQ(root.at("outages").items()[0].at("start_s").number(), 10.5);
  EXPECT_FALSE(root.find("gnss"));
}

TEST(Node, DefaultsWhereTheKeyIsAbsent) {
  const Node imu = sample().at("imu");
  EXPECT_EQ(imu.number("rate_hz", 7.0), 100.0);
  EXPECT_EQ(imu.number("absent", 7.0), 7.0);
  EXPECT_EQ(imu.integer("absent", 3), 3);
  EXPECT_TRUE(imu.flag("absent", true));
  EXPECT_FALSE(imu.flag("filtered", true));
  EXPECT_EQ(imu.text("absent", "x"), "x");
  EXPECT_EQ(imu.vector3("absent", {1, 2, 3}), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(imu.choice("absent", {"a", "b"}, 1), 1U);
  EXPECT_EQ(Node().number("anything", 2.5), 2.5);
}

TEST(Node, SectionIsThereOrEmpty) {
  const Node root = sample();
  EXPECT_EQ(root.section("imu").at("rate_hz").integer(), 100);
  EXPECT_EQ(root.section("vehicle").number("speed", 4.0), 4.0);
  EXPECT_EQ(root.section("vehicle").section("tyre").integer("radius", 1), 1);
  EXPECT_EQ(message_of([&] { (void)root.section("start"); }), "runs/run.yaml:7: start: 'auto', expected a map of keys");
}

TEST(Node, ErrorsNameFileLineAndKey) {
  const Node root = sample();
  const Node imu = root.at("imu");
  EXPECT_EQ(message_of([&] { (void)imu.at("file").number(); }),
            "runs/run.yaml:2: imu.file: 'data/imu.csv', expected a finite number");
  EXPECT_EQ(message_of([&] { (void)imu.at("lever_arm_m").number(); }),
            "runs/run.yaml:4: imu.lever_arm_m: a list of 3, expected a finite number");
  EXPECT_EQ(message_of([&] { (void)imu.at("axes").numbers(); }), "runs/run.yaml:5: imu.axes[0]: 'x', expected a finite number");
  EXPECT_EQ(message_of([&] { (void)imu.at("axes").vector3(); }),
            "runs/run.yaml:5: imu.axes: a list of 2, expected a list of three numbers");
  EXPECT_EQ(message_of([&] { (void)root.at("start").flag(); }), "runs/run.yaml:7: start: 'auto', expected true or false");
  EXPECT_EQ(message_of([&] { (void)root.at("outages").items()[0].at("start_s").integer(); }),
            "runs/run.yaml:9: outages[0].start_s: '10.5', expected a whole number");
  EXPECT_EQ(message_of([&] { (void)root.at("empty").text(); }), "runs/run.yaml:10: empty: no value, expected a single value");
  EXPECT_EQ(message_of([&] { (void)root.at("start").items(); }), "runs/run.yaml:7: start: 'auto', expected a list");
  EXPECT_EQ(message_of([&] { (void)root.at("start").at("time_s"); }),
            "runs/run.yaml:7: start: 'auto', expected a map with the key 'time_s'");
  EXPECT_EQ(root.at("start").where(), "runs/run.yaml:7: start");
  EXPECT_STREQ(imu.at("rate_hz").error("100", "at least 200", "Use another IMU.").what(),
               "runs/run.yaml:3: imu.rate_hz: 100, expected at least 200. Use another IMU.");
}

TEST(Node, MissingKeyNamesTheNearestThatNobodyAskedFor) {
  const Node imu = sample().at("imu");
  EXPECT_EQ(message_of([&] { (void)imu.at("rate"); }),
            "runs/run.yaml:1: imu: the key 'rate' is missing. Add it.");  // 'rate_hz' is 3 edits away, more than half of 4
  EXPECT_EQ(message_of([&] { (void)imu.at("rate_z"); }),
            "runs/run.yaml:1: imu: the key 'rate_z' is missing. Is 'rate_hz' meant to be it?");
  (void)imu.at("rate_hz");
  EXPECT_EQ(message_of([&] { (void)imu.at("rate_z"); }), "runs/run.yaml:1: imu: the key 'rate_z' is missing. Add it.");
}

Node scalar(const std::string& text) {
  TreeBuilder b("a.yaml");
  b.add_scalar(b.root_map(1), "value", text, 1);
  return b.finish().at("value");
}

TEST(Node, NumbersAsYamlWritesThem) {
  EXPECT_EQ(scalar("+1.5").number(), 1.5);
  EXPECT_EQ(scalar(".5").number(), 0.5);
  EXPECT_EQ(scalar("5.").number(), 5.0);
  EXPECT_EQ(scalar("-3.6e-5").number(), -3.6e-5);
  EXPECT_EQ(scalar("0.1").number(), 0.1);
  EXPECT_EQ(scalar("-12").integer(), -12);
  for (const char* bad : {"", "1,5", "1.5 ", "nan", ".nan", "inf", "-.inf", "1e999", "0x10", "1_000", "12 m", "+-3"}) {
    EXPECT_THROW((void)scalar(bad).number(), InputError) << bad;
  }
  for (const char* bad : {"1.0", "1e3", "99999999999999999999", "ten"}) {
    EXPECT_THROW((void)scalar(bad).integer(), InputError) << bad;
  }
  for (const char* bad : {"yes", "True", "1", "on"}) EXPECT_THROW((void)scalar(bad).flag(), InputError) << bad;
}

TEST(Node, ChoiceNamesTheNearest) {
  const std::vector<std::string_view> smoothers = {"rts", "batch", "none"};
  EXPECT_EQ(scalar("batch").choice(smoothers), 1U);
  EXPECT_EQ(message_of([&] { (void)scalar("bacht").choice(smoothers); }),
            "a.yaml:1: value: 'bacht', expected one of rts | batch | none. The nearest is 'batch'.");
  EXPECT_EQ(message_of([&] { (void)scalar("kalman").choice(smoothers); }),
            "a.yaml:1: value: 'kalman', expected one of rts | batch | none");
}

TEST(Node, RangesAreChecked) {
  const Node imu = sample().at("imu");
  EXPECT_EQ(imu.number_within("rate_hz", 1.0, 100.0, 200.0), 100.0);
  EXPECT_EQ(imu.number_within("absent", 1.0, 0.0, 2.0), 1.0);
  EXPECT_EQ(message_of([&] { (void)imu.number_within("rate_hz", 1.0, 0.0, 99.0); }),
            "runs/run.yaml:3: imu.rate_hz: 100, expected a number from 0 to 99");
}

TEST(Node, PathsCountFromTheFileThatContainsThem) {
  EXPECT_EQ(sample("/data/runs/run.yaml").at("imu").at("file").path(), "/data/runs/data/imu.csv");
  EXPECT_EQ(sample("run.yaml").at("imu").at("file").path(), std::filesystem::current_path() / "data/imu.csv");
  EXPECT_EQ(scalar("/absolute/../b.csv").path(), "/b.csv");
  EXPECT_THROW((void)scalar("").path(), InputError);
  EXPECT_THROW((void)sample().at("outages").path(), InputError);
}

// Sets COAST_DATA for one test and puts it back.
class DataVariable {
 public:
  explicit DataVariable(const char* value) {
    if (const char* old = std::getenv("COAST_DATA")) old_ = old;
    value != nullptr ? setenv("COAST_DATA", value, 1) : unsetenv("COAST_DATA");
  }
  ~DataVariable() { old_ ? setenv("COAST_DATA", old_->c_str(), 1) : unsetenv("COAST_DATA"); }
  DataVariable(const DataVariable&) = delete;
  DataVariable& operator=(const DataVariable&) = delete;

 private:
  std::optional<std::string> old_;
};

TEST(Node, OnlyTheDataFolderIsExpandedAndOnlyInPaths) {
  const DataVariable variable("/recordings");
  EXPECT_EQ(scalar("${COAST_DATA}/car/imu.csv").path(), "/recordings/car/imu.csv");
  EXPECT_EQ(scalar("${COAST_DATA}/car/imu.csv").text(), "${COAST_DATA}/car/imu.csv");
  EXPECT_THROW((void)scalar("${HOME}/imu.csv").path(), InputError);
  EXPECT_THROW((void)scalar("x/${COAST_DATA}").path(), InputError);
}

TEST(Node, DataFolderThatIsNotSetIsSaid) {
  for (const char* value : {static_cast<const char*>(nullptr), ""}) {
    const DataVariable variable(value);
    EXPECT_EQ(
        message_of([&] { (void)scalar("${COAST_DATA}/imu.csv").path(); }),
        "a.yaml:1: value: '${COAST_DATA}/imu.csv', but COAST_DATA is not set, expected the folder of the recordings in it. "
        "Set the environment variable COAST_DATA, or write the path out.");
  }
}

TEST(TreeBuilder, RefusesWhatIsNoTree) {
  TreeBuilder b("a.yaml");
  EXPECT_THROW((void)b.finish(), std::invalid_argument);
  const auto root = b.root_map(1);
  EXPECT_THROW((void)b.root_list(1), std::invalid_argument);
  const auto leaf = b.add_scalar(root, "a", "1", 1);
  EXPECT_THROW((void)b.add_scalar(leaf, "b", "1", 1), std::invalid_argument);
}

TEST(Nearest, IsEmptyWhereNothingIsNear) {
  EXPECT_EQ(nearest("smooter", {"smoother", "start"}), "smoother");
  EXPECT_EQ(nearest("zzz", {"smoother", "start"}), "");
}

}  // namespace
}  // namespace coast::config
