// coast ppk as a user runs it: from RINEX to positions, their page and their trajectory; what is spoiled.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "coast/io/gnss.hpp"
#include "coast/jobs/ppk.hpp"
#include "program.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

using namespace jobs;

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kMission = R"(
schema: coast.scenario/1
trajectory: {kind: car_roundabout, duration_s: 360, static_s: 30, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 100, error_model: model.yaml, lever_arm_m: [0.3, -0.2, -1.1]}
gnss:
  sd_m: [0.01, 0.01, 0.02]
  observations: {phase_multipath_sd_m: 0.001, slips_per_hour: 4, obstacles: [{elapsed_s: 200, duration_s: 20, below_deg: 80}]}
start_gps: {week: 2374, sow: 208800}
seed: 4
)";

/// RINEX files of a simulated mission, made once for the tests of this file.
const fs::path& rinex() {
  static const test::TemporaryDirectory folder;
  static const fs::path made = simulated_recording(kMission, folder.path());
  return made;
}

json json_of(const fs::path& file) {
  return json::parse(text_of(file));
}

TEST(PpkCommand, GoesFromRinexToPositions) {
  const test::TemporaryDirectory folder;
  const fs::path out = folder.path() / "out";
  const Outcome outcome =
      run(fmt::format("ppk '{}' --out '{}'", (rinex() / "run-rinex.yaml").string(), out.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const json result = json_of(out / "ppk.json");
  test::expect_valid("ppk_result", result);
  EXPECT_EQ(result["epochs"]["expected"], 360);
  EXPECT_GE(result["epochs"]["fixed"], 335);  // 20 s below a bridge
  EXPECT_FALSE(result["not_fixed_because"].empty());
  io::GnssFileOptions options;
  options.file = out / "ppk.pos";
  const record::GnssRecording fixes = io::read_gnss(options);
  EXPECT_GE(fixes.fixes.size(), 335U);
  EXPECT_TRUE(fixes.fixes.front().velocity);
  EXPECT_NE(text_of(out / "residuals.csv").find(",phase,"), std::string::npos);
  for (const char* file : {"report.html", "report.json", "ppk.resolved.yaml"}) EXPECT_TRUE(fs::exists(out / file)) << file;
  // The resolved file gives the same positions again.
  std::string text = text_of(out / "ppk.resolved.yaml");
  write(folder.path() / "again.yaml", text);
  const Outcome again = run(fmt::format("ppk '{}'", (folder.path() / "again.yaml").string()), folder.path());
  ASSERT_EQ(again.status, 0) << again.error;
  EXPECT_EQ(text_of(folder.path() / "again.out" / "ppk.pos"), text_of(out / "ppk.pos"));
}

TEST(PpkCommand, FeedsTheNavigationFilterInOneCommand) {
  const test::TemporaryDirectory folder;
  const fs::path out = folder.path() / "out";
  const Outcome outcome =
      run(fmt::format("process '{}' --out '{}'", (rinex() / "run-rinex.yaml").string(), out.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const json summary = json_of(out / "summary.json");
  test::expect_valid("summary", summary);
  // Centimetres of carrier phases, smoothed, 20 s without any; the sensor is a good MEMS.
  for (const json& rms : summary["reference"]["smoothed"]["position_rms_m"]) EXPECT_LT(rms.get<double>(), 0.06);
  EXPECT_NE(text_of(folder.path() / "stdout.txt").find("epochs fixed"), std::string::npos);
}

TEST(PpkCommand, WarnsOfABaseThatItsOwnCodesPutElsewhere) {
  const test::TemporaryDirectory folder;
  const auto with = [&](const char* line) {
    write(folder.path() / "ppk.yaml",
          fmt::format("rover: {0}/rover.obs\nbase: {0}/base.obs\nnav: [{0}/brdc.nav]\n{1}\n", rinex().string(), line));
    const Outcome outcome = run(fmt::format("ppk '{}'", (folder.path() / "ppk.yaml").string()), folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    const bool in_file = text_of(folder.path() / "ppk.out" / "ppk.json").find("base_position_doubtful") != std::string::npos;
    EXPECT_EQ(outcome.error.find("warning:") != std::string::npos && outcome.error.find("sigma") != std::string::npos, in_file);
    return in_file;
  };
  EXPECT_FALSE(with("base_position: header"));
  EXPECT_TRUE(with("# nobody says where the base is"));
  EXPECT_TRUE(with("base_position: {geodetic_deg_m: [46.548, 6.583, 400]}"));  // 110 m to the north
}

/// The mission's run file with other outages and coupling.
fs::path run_file(const fs::path& folder, const std::string& gnss, const std::string& outages) {
  std::string text = text_of(rinex() / "run-rinex.yaml");
  const auto replace = [&text](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  replace("gnss: {", "gnss: {" + gnss);
  for (const char* file : {"rover.obs", "base.obs", "brdc.nav", "imu.csv", "error_model.yaml", "truth.nav"})
    replace(file, (rinex() / file).string());
  write(folder / "run.yaml", text + outages);
  return folder / "run.yaml";
}

TEST(PpkCommand, TightlyCoupledRunUsesThreeSatellites) {
  const test::TemporaryDirectory folder;
  const fs::path yaml =
      run_file(folder.path(), "coupling: tight, ", "outages: [{start_s: 208920, duration_s: 30, satellites: 3}]\n");
  const Outcome outcome = run(fmt::format("process '{}'", yaml.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const json summary = json_of(folder.path() / "run.out" / "summary.json");
  test::expect_valid("summary", summary);
  EXPECT_GE(summary["gnss"]["used"], 335);
  for (const json& rms : summary["reference"]["smoothed"]["position_rms_m"]) EXPECT_LT(rms.get<double>(), 0.06);
  // Inertial navigation alone is a metre off after 30 s; three satellites hold two directions of four unknowns' three.
  for (const json& end : summary["outages"][0]["forward"]["end_m"]) EXPECT_LT(std::abs(end.get<double>()), 0.5);
  const json page = json_of(folder.path() / "run.out" / "report.json");
  EXPECT_NE(page.dump().find("carrier phases"), std::string::npos);
}

struct SpoiledCoupling {
  const char* gnss;
  const char* outages;
  const char* message;
};

class SpoiledCouplings : public testing::TestWithParam<SpoiledCoupling> {};

TEST_P(SpoiledCouplings, EndWithStatusTwoAndSayWhat) {
  const test::TemporaryDirectory folder;
  fs::path yaml;
  if (std::string(GetParam().outages) == "moving") {
    std::string text = text_of(run_file(folder.path(), GetParam().gnss, ""));
    text.replace(text.find("{ecef_m"), text.find("]}", text.find("{ecef_m")) + 2 - text.find("{ecef_m"), "moving");
    write(folder.path() / "moving.yaml", text);
    yaml = folder.path() / "moving.yaml";
  } else {
    yaml = run_file(folder.path(), GetParam().gnss, GetParam().outages);
  }
  const Outcome outcome = run(fmt::format("process '{}'", yaml.string()), folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.error;
  EXPECT_NE(outcome.error.find(GetParam().message), std::string::npos) << outcome.error;
}

INSTANTIATE_TEST_SUITE_P(
    PpkCommand, SpoiledCouplings,
    testing::Values(SpoiledCoupling{"coupling: close, ", "", "loose"},
                    SpoiledCoupling{"coupling: tight, noise: estimated, ", "", "does not use"},
                    SpoiledCoupling{"coupling: tight, ", "moving", "moving base"},
                    SpoiledCoupling{"", "outages: [{start_s: 208920, duration_s: 30, satellites: 3}]\n", "partial outage"},
                    SpoiledCoupling{"coupling: tight, ", "outages: [{start_s: 208920, duration_s: 30, satellites: -1}]\n",
                                    "-1 satellites"}),
    [](const testing::TestParamInfo<SpoiledCoupling>& spoiled) { return fmt::format("n{}", spoiled.index); });

TEST(PpkCommand, ExampleOfTheHelpPageIsThatOfTheSchema) {
  EXPECT_EQ(test::yaml_as_json(ppk_example("")), test::schema("ppk").at("examples").at(0));
}

struct SpoiledPpk {
  const char* name;
  const char* from;
  const char* to;
  const char* message;  ///< must be part of standard error
};

class SpoiledPpkFile : public testing::TestWithParam<SpoiledPpk> {};

TEST_P(SpoiledPpkFile, EndsWithStatusTwoAndSaysWhat) {
  const test::TemporaryDirectory folder;
  std::string text =
      fmt::format("rover: {0}/rover.obs\nbase: {0}/base.obs\nnav: [{0}/brdc.nav]\nbase_position: header\nmotion: kinematic\n",
                  rinex().string());
  const auto at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos) << text;
  text.replace(at, std::string(GetParam().from).size(), GetParam().to);
  write(folder.path() / "spoiled.yaml", text);
  const Outcome outcome = run(fmt::format("ppk '{}'", (folder.path() / "spoiled.yaml").string()), folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.error;
  EXPECT_NE(outcome.error.find(GetParam().message), std::string::npos) << outcome.error;
  EXPECT_FALSE(fs::exists(folder.path() / "spoiled.out" / "ppk.pos"));
}

INSTANTIATE_TEST_SUITE_P(
    PpkCommand, SpoiledPpkFile,
    testing::Values(
        SpoiledPpk{"unknown key", "motion:", "moton:", "moton"}, SpoiledPpk{"no rover", "rover:", "#", "rover"},
        SpoiledPpk{"a word", "kinematic", "flying", "flying"},
        SpoiledPpk{"a base in space", "header", "{ecef_m: [1, 2, 3]}", "not on the Earth"},
        SpoiledPpk{"a base of the other hemisphere", "header", "{geodetic_deg_m: [-46.547, 6.583, 400]}",
                   "of z changed it fits: a sign?"},
        SpoiledPpk{"rover for base", "base.obs", "rover.obs", "the observations of the rover"},
        SpoiledPpk{"a base of two numbers", "header", "{ecef_m: [1, 2]}", "ecef_m"},
        SpoiledPpk{"a frame that nobody knows", "header", "{ecef_m: [4365683, 503817, 4607565], frame: ITRF1800, epoch: 2020}",
                   "one of"},
        SpoiledPpk{"a frame without an epoch", "header", "{ecef_m: [4365683, 503817, 4607565], frame: ITRF2014}", "epoch"},
        SpoiledPpk{"a plate that nobody knows", "header",
                   "{ecef_m: [4365683, 503817, 4607565], frame: ITRF2014, epoch: 2020, plate: ATLANTIS}", "EURA"},
        SpoiledPpk{"an epoch without a frame", "header", "{ecef_m: [4365683, 503817, 4607565], epoch: 2020}", "epoch"},
        SpoiledPpk{"a missing file", "rover.obs", "rovr.obs", "rovr.obs"},
        SpoiledPpk{"navigation for observations", "rover.obs", "brdc.nav", "brdc.nav"},
        SpoiledPpk{"observations for navigation", "brdc.nav", "base.obs", "base.obs"},
        SpoiledPpk{"no system in common", "motion: kinematic", "systems: [glonass]", "no signal"}),
    [](const testing::TestParamInfo<SpoiledPpk>& spoiled) { return fmt::format("n{}", spoiled.index); });

TEST(PpkCommand, EveryShippedFileIsSolved) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: the real recordings are not at hand";
  std::size_t files = 0;
  for (const auto& file : fs::directory_iterator(fs::path(COAST_SOURCE_DIR) / "configs" / "ppk")) {
    const test::TemporaryDirectory folder;
    const Outcome outcome =
        run(fmt::format("ppk '{}' --out '{}'", file.path().string(), (folder.path() / "out").string()), folder.path());
    EXPECT_EQ(outcome.status, 0) << file.path() << outcome.error;
    const json result = json_of(folder.path() / "out" / "ppk.json");
    EXPECT_GT(result["fix_rate"].get<double>(), 0.99) << file.path();
    if (result.contains("forward_backward_m")) {
      EXPECT_EQ(result["forward_backward_m"]["both_fixed_above_0.1_m"], 0) << file.path();
    }
    ++files;
  }
  EXPECT_GE(files, 3U);
}

}  // namespace
}  // namespace coast::cli
