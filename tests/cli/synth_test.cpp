// coast synth as a user runs it: from the recordings of several IMUs to one, its page and its trajectory; what is spoiled.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "coast/jobs/synth.hpp"
#include "program.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

using namespace jobs;

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kArrayMission = R"(
schema: coast.scenario/1
trajectory: {kind: car_roundabout, duration_s: 360, static_s: 30, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 100, error_model: model.yaml, lever_arm_m: [0.3, -0.2, -1.1]}
gnss: {rate_hz: 5, sd_m: [0.01, 0.01, 0.02]}
array:
  - {name: front, error_model: model.yaml, position_m: [0.1, 0, 0]}
  - {name: left, error_model: model.yaml, position_m: [0, -0.15, 0], axes: [y, -x, z], clock_offset_s: 0.0073}
  - {name: right, error_model: model.yaml, position_m: [0, 0.15, 0], mounting_deg: [0, 0, 2], clock_offset_s: -0.0021, clock_drift_ppm: 15}
outages: [{manoeuvre: roundabout, duration_s: 20}]
start_gps: {week: 2374, sow: 208800}
seed: 4
)";

/// A simulated array, made once for the tests of this file.
const fs::path& recorded_array() {
  static const test::TemporaryDirectory folder;
  static const fs::path made = simulated_recording(kArrayMission, folder.path());
  return made;
}

json read_json(const fs::path& file) {
  return json::parse(text_of(file));
}

TEST(SynthCommand, MergesAnArrayThatTheFilterTakes) {
  const test::TemporaryDirectory folder;
  const fs::path out = folder.path() / "out";
  const Outcome outcome =
      run(fmt::format("synth '{}' --out '{}'", (recorded_array() / "array.yaml").string(), out.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const json result = read_json(out / "synth.json");
  test::expect_valid("synth", result);
  // Clocks as simulated, against the first: at the middle of the record. Five of their stated sigmas, and no more than 0.3 ms.
  const json& imus = result["imus"];
  for (const auto& [k, truth] : {std::pair{1, 0.0073}, std::pair{2, -0.0021 + 15e-6 * 180.0}}) {
    const json& lag = imus[static_cast<std::size_t>(k)]["lag"];
    EXPECT_NEAR(lag["offset_s"].get<double>(), truth, 5.0 * lag["offset_sigma_s"].get<double>() + 2e-5);
    EXPECT_LT(lag["offset_sigma_s"].get<double>(), 1e-4);
  }
  // Three like sensors with independent noise.
  for (const json& channel : result["channels"])
    EXPECT_NEAR(channel["merged_sd"].get<double>() / channel["sensors"][0]["noise_sd"].get<double>(), 1.0 / std::sqrt(3.0),
                0.06);
  EXPECT_TRUE(result["defects"].empty()) << result["defects"].dump(1);
  for (const char* file : {"report.html", "report.json", "array.resolved.yaml"}) EXPECT_TRUE(fs::exists(out / file)) << file;

  // The synthetic IMU goes into the filter like any other, at the body's point, and solves the mission better than one alone.
  const auto end_error = [&](const std::string& name, const std::string& imu) {
    std::string text = text_of(recorded_array() / "run.yaml");
    const auto replace = [&text](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace("file: imu.csv", imu);
    replace("gnss.pos", (recorded_array() / "gnss.pos").string());
    replace("truth.nav", (recorded_array() / "truth.nav").string());
    replace("  error_model: error_model.yaml\n", "");
    write(folder.path() / (name + ".yaml"), text);
    const Outcome solved = run(fmt::format("process '{}'", (folder.path() / (name + ".yaml")).string()), folder.path());
    EXPECT_EQ(solved.status, 0) << solved.error;
    const json summary = read_json(folder.path() / (name + ".out") / "summary.json");
    for (const json& rms : summary["reference"]["smoothed"]["position_rms_m"]) EXPECT_LT(rms.get<double>(), 0.05) << name;
    return std::hypot(summary["outages"][0]["forward"]["max_m"][0].get<double>(),
                      summary["outages"][0]["forward"]["max_m"][1].get<double>());
  };
  const double merged =
      end_error("merged", fmt::format("file: {}\n  noise_levels: {}\n  error_model: {}", (out / "imu.csv").string(),
                                      (out / "noise.csv").string(), (out / "error_model.yaml").string()));
  EXPECT_LT(merged, 5.0);  // m in 20 s: one sensor of this kind drifts by about 3
}

TEST(SynthCommand, ExtendedKeepsTheErrorStatesOfEachImu) {
  const test::TemporaryDirectory folder;
  const fs::path out = folder.path() / "out";
  fs::copy(recorded_array(), folder.path(), fs::copy_options::recursive);
  write(folder.path() / "array.yaml", text_of(folder.path() / "array.yaml") + "merge: {method: extended}\n");
  const Outcome outcome =
      run(fmt::format("synth '{}' --out '{}'", (folder.path() / "array.yaml").string(), out.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  test::expect_valid("synth", read_json(out / "synth.json"));
  test::expect_valid("imu_error_model", test::yaml_as_json(text_of(out / "error_model.yaml")));
  const auto solve = [&](const std::string& name, const std::string& imu) {
    std::string text = text_of(folder.path() / "run.yaml");
    text.replace(text.find("file: imu.csv"), 13, imu);
    text.replace(text.find("  error_model: error_model.yaml\n"), 32, "");
    write(folder.path() / (name + ".yaml"), text);
    const Outcome solved = run(fmt::format("process '{}'", (folder.path() / (name + ".yaml")).string()), folder.path());
    EXPECT_EQ(solved.status, 0) << solved.error;
    return read_json(folder.path() / (name + ".out") / "summary.json");
  };
  const std::string sum =
      fmt::format("file: {}\n  error_model: {}", (out / "imu.csv").string(), (out / "error_model.yaml").string());
  const json told_apart = solve("extended", sum + fmt::format("\n  members: {}", (out / "members.csv").string()));
  for (const json& rms : told_apart["reference"]["smoothed"]["position_rms_m"]) EXPECT_LT(rms.get<double>(), 0.05);
  // One sensor of this kind drifts by about 3 m in 20 s. Without their differences the members are known as their sum alone is.
  EXPECT_LT(told_apart["outages"][0]["forward"]["max_m"][0].get<double>(), 5.0);
  const json together = solve("together", sum);
  EXPECT_NE(together["outages"][0]["forward"]["max_m"], told_apart["outages"][0]["forward"]["max_m"]);
  // Every member's states are there to be seen.
  const std::string page = text_of(folder.path() / "extended.out" / "report.json");
  for (const char* name : {"of front", "of left", "of right", "members of the IMU"})
    EXPECT_NE(page.find(name), std::string::npos) << name;
}

TEST(SynthCommand, ResolvedFileGivesTheSameAgain) {
  const test::TemporaryDirectory folder;
  std::string text = text_of(recorded_array() / "array.yaml");
  for (const char* file : {"imu_front.csv", "imu_left.csv", "imu_right.csv", "error_model_front.yaml", "error_model_left.yaml",
                           "error_model_right.yaml"})
    text.replace(text.find(file), std::string(file).size(), (recorded_array() / file).string());
  write(folder.path() / "array.yaml", text + "merge: {method: corrected, orders: [1, 0, 1, 1]}\nmounting: {refine: true}\n");
  const Outcome first = run(fmt::format("synth '{}'", (folder.path() / "array.yaml").string()), folder.path());
  ASSERT_EQ(first.status, 0) << first.error;
  const fs::path out = folder.path() / "array.out";
  write(folder.path() / "again.yaml", text_of(out / "array.resolved.yaml"));
  const Outcome again = run(fmt::format("synth '{}'", (folder.path() / "again.yaml").string()), folder.path());
  ASSERT_EQ(again.status, 0) << again.error;
  EXPECT_EQ(text_of(folder.path() / "again.out" / "imu.csv"), text_of(out / "imu.csv"));
  const json result = read_json(out / "synth.json");
  test::expect_valid("synth", result);
  EXPECT_TRUE(result["channels"][0]["sensors"][0].contains("arma_garch"));
  // The mounting was stated as it is: what is refined is noise.
  for (const json& imu : result["imus"])
    for (const json& angle : imu["mounting"]["rotation_deg"]) EXPECT_LT(std::abs(angle.get<double>()), 0.1);
}

struct SpoiledArray {
  const char* yaml;
  const char* message;
};

class SpoiledArrays : public testing::TestWithParam<SpoiledArray> {};

TEST_P(SpoiledArrays, EndWithStatusTwoAndSayWhat) {
  const test::TemporaryDirectory folder;
  write(folder.path() / "array.yaml", GetParam().yaml);
  const Outcome outcome = run(fmt::format("synth '{}'", (folder.path() / "array.yaml").string()), folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.error.find(GetParam().message), std::string::npos) << outcome.error;
  EXPECT_FALSE(fs::exists(folder.path() / "array.out" / "imu.csv"));
}

INSTANTIATE_TEST_SUITE_P(
    Files, SpoiledArrays,
    testing::Values(SpoiledArray{"imus: [{file: a.csv}]\n", "two or more"},
                    SpoiledArray{"imus: [{name: a, file: a.csv}, {name: a, file: b.csv}]\n", "a name of its own"},
                    SpoiledArray{"imus: [{file: a.csv}, {file: b.csv}]\nmerge: {method: best}\n", "mean"},
                    SpoiledArray{"imus: [{file: a.csv}, {file: b.csv}]\nmerge: {orders: [1, 1, 0, 1]}\n", "q without p"},
                    SpoiledArray{"imus: [{file: a.csv}, {file: b.csv}]\nmerge: {orders: [1, 1]}\n", "d, h, p, q"},
                    SpoiledArray{"imus: [{file: a.csv}, {file: b.csv}]\nmerge: {method: extended}\n", "no error_model of imu1"},
                    SpoiledArray{"imus: [{name: 'a, b', file: a.csv}, {file: b.csv}]\n", "without commas"},
                    SpoiledArray{"imus: [{file: a.csv}, {file: b.csv}]\ndefect: {find: true}\n", "defects"},
                    SpoiledArray{"imus: [{file: a.csv}, {file: b.csv}]\ntime: {by: packets, gps_week: 2300}\n", "columns"},
                    SpoiledArray{"imus: [{file: a.csv}, {file: b.csv}]\n", "a.csv"}));

TEST(SynthCommand, EveryShippedArrayIsMerged) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: the real recordings are not at hand";
  std::size_t files = 0;
  for (const auto& file : fs::directory_iterator(fs::path(COAST_SOURCE_DIR) / "configs" / "arrays")) {
    const test::TemporaryDirectory folder;
    const Outcome outcome =
        run(fmt::format("synth '{}' --out '{}'", file.path().string(), (folder.path() / "out").string()), folder.path());
    ASSERT_EQ(outcome.status, 0) << file.path() << outcome.error;
    const json result = read_json(folder.path() / "out" / "synth.json");
    test::expect_valid("synth", result);
    for (const json& channel : result["channels"]) {
      double best = std::numeric_limits<double>::infinity();
      for (const json& sensor : channel["sensors"]) best = std::min(best, sensor["noise_sd"].get<double>());
      EXPECT_LT(channel["merged_sd"].get<double>(), best) << file.path() << channel["name"];
    }
    ++files;
  }
  EXPECT_GE(files, 3U);
}

TEST(SynthExample, IsThatOfItsSchema) {
  EXPECT_EQ(test::yaml_as_json(array_example("")), test::schema("array").at("examples").at(0));
  test::expect_valid("array", test::schema("array").at("examples").at(0));
  const test::TemporaryDirectory folder;
  write(folder.path() / "array.yaml", array_example(""));
  const ArrayConfig config = read_synth(folder.path() / "array.yaml");
  EXPECT_EQ(config.imus.size(), 3U);
  EXPECT_EQ(config.merge.merge, array::Merge::kCorrected);
  ASSERT_EQ(run("synth --help", folder.path()).status, 0);
  EXPECT_NE(text_of(folder.path() / "stdout.txt").find(array_example("  ")), std::string::npos);
}

}  // namespace
}  // namespace coast::cli
