// coast outage as a user runs it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coast/io/yaml.hpp"
#include "coast/jobs/outage.hpp"
#include "program.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

using namespace jobs;

namespace fs = std::filesystem;

constexpr const char* kStudiedDrive = R"(
schema: coast.scenario/1
trajectory: {kind: car_roundabout, duration_s: 360, static_s: 30, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 100, error_model: model.yaml, lever_arm_m: [0.3, -0.2, -1.1]}
gnss: {rate_hz: 2, sd_m: [0.01, 0.01, 0.02]}
start_gps: {week: 2374, sow: 208800}
seed: 4
)";

/// A simulated recording, made once for the tests of this file.
const fs::path& studied_drive() {
  static const test::TemporaryDirectory folder;
  static const fs::path made = simulated_recording(kStudiedDrive, folder.path());
  return made;
}

/// A shipped study with few seeds, where a test can write beside it.
fs::path shipped_study(const char* name, const fs::path& folder, const char* count) {
  const fs::path configs = fs::path(COAST_SOURCE_DIR) / "configs";
  std::string text = text_of(configs / "studies" / name);
  const auto replace = [&text](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  replace("count: 100", fmt::format("count: {}", count));
  replace(": ../", fmt::format(": {}/", configs.string()));
  for (const char* floor : {"gyro_white_noise.yaml", "white_noise.yaml"})
    replace(fmt::format("file: {}", floor), fmt::format("file: {}", (configs / "studies" / floor).string()));
  write(folder / name, text);
  return folder / name;
}

/// outages.csv: column by name, row by row. Names of models stand in quotes.
std::vector<std::map<std::string, std::string>> outage_rows(const fs::path& folder) {
  std::istringstream text(text_of(folder / "outages.csv"));
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
  for (std::string line; std::getline(text, line);) {
    std::vector<std::string> values;
    std::istringstream fields(line + ",");
    for (std::string field; std::getline(fields, field, ',');) values.push_back(field);
    if (names.empty()) {
      names = values;
      continue;
    }
    EXPECT_EQ(values.size(), names.size()) << line;
    rows.emplace_back();
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) rows.back()[names[i]] = values[i];
  }
  return rows;
}

/// A study that has run: its outage.json, valid by its schema.
nlohmann::json studied(const fs::path& study, const fs::path& out, const fs::path& folder) {
  const Outcome outcome = run(fmt::format("outage '{}' --out '{}'", study.string(), out.string()), folder);
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_FALSE(fs::exists(out / "outages.partial"));
  test::expect_valid("study", test::load_yaml_as_json(study));
  const nlohmann::json page = nlohmann::json::parse(text_of(out / "report.json"));
  test::expect_valid("page", page);
  for (const nlohmann::json& section : page["sections"])
    for (const nlohmann::json& panel : section.value("panels", nlohmann::json::array()))
      for (const nlohmann::json& plot : panel["plots"])
        EXPECT_TRUE(plot.contains("lines") || plot.contains("points") || plot.contains("bars")) << panel["id"] << plot["title"];
  auto result = nlohmann::json::parse(text_of(out / "outage.json"));
  test::expect_valid("outage", result);
  return result;
}

TEST(OutageStudy, ShippedEnsembleRunsWithTwoSeeds) {
  const test::TemporaryDirectory folder;
  const fs::path study = shipped_study("roundabout_20s.yaml", folder.path(), "2");
  const fs::path out = folder.path() / "out";
  const auto result = studied(study, out, folder.path());
  EXPECT_GT(fs::file_size(out / "report.html"), 100000U);
  ASSERT_EQ(result["outages"].size(), 1U);
  const auto& outage = result["outages"][0];
  EXPECT_EQ(outage["duration_s"], 20.0);
  EXPECT_EQ(outage["starts_s"].size(), 1U);
  ASSERT_EQ(outage["runs"].size(), 6U);  // two truths with two error models each, and two floors
  for (const auto& run : outage["runs"]) {
    for (const char* axis : {"n", "e"}) {
      // Two normal errors: their mean square over the variance stays below 12 but once in 160 thousand (chi-square, 2 dof).
      const auto& end = run["forward"]["end"][axis];
      EXPECT_LT(end["rms_m"].get<double>(), std::sqrt(12.0) * end["predicted_rms_m"].get<double>());
      EXPECT_GT(end["predicted_rms_m"].get<double>(), run["gyro_noise_alone_m"].get<double>());
    }
    EXPECT_LT(run["smoothed"]["largest"]["horizontal"]["rms_m"].get<double>(),
              0.5 * run["forward"]["largest"]["horizontal"]["rms_m"].get<double>());
    ASSERT_EQ(run["manoeuvres"].size(), 1U);
    EXPECT_EQ(run["manoeuvres"][0]["manoeuvre"], "turn");
    EXPECT_EQ(run["manoeuvres"][0]["outages"], 2);
  }
  // Of either truth: EM and two floors against the manufacturer's model, forward and smoothed.
  ASSERT_EQ(outage["paired"].size(), 12U);
  EXPECT_EQ(outage["paired"][0]["second"], "EM");
  const auto rows = outage_rows(out);
  ASSERT_EQ(rows.size(), 12U);  // run by run, seed by seed
  EXPECT_EQ(rows[3].at("error_model"), "\"EM\"");
  EXPECT_EQ(rows[3].at("seed"), "2");
  const auto drift = [&](std::size_t row) { return std::stod(rows[row].at("forward_horizontal_max_m")); };
  const double ratio = std::sqrt(drift(2) * drift(3) / drift(0) / drift(1));
  EXPECT_NEAR(outage["paired"][0]["horizontal"]["ratio"].get<double>(), ratio, 1e-12);
  EXPECT_EQ(outage["runs"][0]["forward"]["largest"]["horizontal"]["max_m"].get<double>(), std::max(drift(0), drift(1)));
}

TEST(OutageStudy, EveryShippedStudyIsRead) {
  std::size_t studies = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(COAST_SOURCE_DIR) / "configs" / "studies")) {
    if (text_of(entry.path()).find("coast.study/1") == std::string::npos) continue;
    const auto study = std::get<EnsembleStudy>(read_outage(entry.path()));
    EXPECT_EQ(study.plan.seeds, 100U) << entry.path();
    EXPECT_EQ(study.plan.cases.size(), 4U) << entry.path();
    ++studies;
  }
  EXPECT_EQ(studies, 2U);
}

void replace_in(std::string& text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

/// A study of outages of 10 s over the recording, each of these models of sensors.
fs::path recording_study(const fs::path& folder, const std::string& models) {
  write(folder / "study.yaml", fmt::format("run: {}\nsweep: {{durations_s: [10], every_s: 40}}\nerror_models:\n{}",
                                           (studied_drive() / "run.yaml").string(), models));
  return folder / "study.yaml";
}

TEST(OutageStudy, SweepsOneRecordingWithTwoErrorModels) {
  const test::TemporaryDirectory folder;
  const std::string model = (studied_drive() / "error_model.yaml").string();
  const fs::path study =
      recording_study(folder.path(), fmt::format("  - {{name: own, file: {}}}\n  - {{name: again, file: {}}}\n", model, model));
  const fs::path out = folder.path() / "out";
  const auto result = studied(study, out, folder.path());
  ASSERT_EQ(result["outages"].size(), 1U);
  const auto& outage = result["outages"][0];
  EXPECT_EQ(outage["starts_s"].size(), 8U);  // 60, 100, .. 340 s of 360 s
  ASSERT_EQ(outage["runs"].size(), 2U);
  for (const char* solution : {"forward", "smoothed", "manoeuvres"})
    EXPECT_EQ(outage["runs"][0][solution], outage["runs"][1][solution]) << solution;
  ASSERT_EQ(outage["paired"].size(), 2U);
  for (const auto& pair : outage["paired"]) {
    EXPECT_EQ(pair["horizontal"]["ratio"], 1.0);  // the same model twice
    EXPECT_EQ(pair["horizontal"]["pairs"], 8);
  }
  EXPECT_EQ(outage_rows(out).size(), 16U);
}

// White noise stated a tenth of what it is: a filter that fits it to the recording predicts what one with the true noise does.
TEST(OutageStudy, EstimatesTheNoiseOfTheRecording) {
  const test::TemporaryDirectory folder;
  std::string scenario = kStudiedDrive;
  replace_in(scenario, "rate_hz: 100", "rate_hz: 50");  // a fit takes many runs
  replace_in(scenario, "rate_hz: 2", "rate_hz: 1");
  const fs::path made = simulated_recording(scenario, folder.path());
  noise::ImuErrorModel quiet = noise::ImuErrorModel::from(io::load_yaml(made / "error_model.yaml"));
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel})
    quiet = quiet.with_white_noise_scaled(sensor, Eigen::Vector3d::Constant(0.1));
  write(made / "quiet.yaml", quiet.yaml());
  write(made / "study.yaml", R"(
run: run.yaml
sweep: {durations_s: [30], first_s: 180, every_s: 20}
error_models:
  - {name: true ones, file: error_model.yaml, noise: stated}
  - {name: stated, file: quiet.yaml, noise: stated}
  - {name: estimated, file: quiet.yaml, noise: estimated}
)");
  const auto result = studied(made / "study.yaml", folder.path() / "out", folder.path());
  const auto& runs = result["outages"][0]["runs"];
  const auto predicted = [&](std::size_t run) {
    const auto& end = runs[run]["forward"]["end"];
    return std::hypot(end["n"]["predicted_rms_m"].get<double>(), end["e"]["predicted_rms_m"].get<double>());
  };
  EXPECT_LT(predicted(1), 0.7 * predicted(0));
  // Densities of gyros and accelerometers, each from some 300 innovations of three axes: 5 % and a few sigmas.
  EXPECT_NEAR(predicted(2), predicted(0), 0.2 * predicted(0));
}

/// A drive that studies simulate; its error model is test::kTestModel.
fs::path ensemble_study(const fs::path& folder, const std::string& keys) {
  write(folder / "scenario.yaml", kStudiedDrive);
  write(folder / "model.yaml", test::kTestModel);
  write(folder / "study.yaml", "schema: coast.study/1\nscenario: scenario.yaml\nseeds: {first: 3, count: 2}\n" + keys);
  return folder / "study.yaml";
}

/// Plots of a page without a line or a point.
std::vector<std::string> empty_plots(const nlohmann::json& page) {
  std::vector<std::string> empty;
  for (const auto& section : page["sections"]) {
    if (!section.contains("panels")) continue;
    for (const auto& panel : section["panels"])
      for (const auto& plot : panel["plots"]) {
        const auto none = [&plot](const char* key) { return !plot.contains(key) || plot[key].empty(); };
        if (none("lines") && none("points") && none("bars") && none("boxes"))
          empty.push_back(fmt::format("{}: {}", panel["id"].get<std::string>(), plot.value("title", "")));
      }
  }
  return empty;
}

TEST(OutageStudy, SweepsSimulatedRecordings) {
  const test::TemporaryDirectory folder;
  const fs::path study = ensemble_study(folder.path(), "sweep: {every_s: 70, first_s: 120, durations_s: [5, 40, 100]}\n");
  const fs::path out = folder.path() / "out";
  const auto result = studied(study, out, folder.path());
  EXPECT_EQ(result["seeds"]["first"], 3);
  EXPECT_EQ(result["seeds"]["count"], 2);
  ASSERT_EQ(result["outages"].size(), 2U);  // 100 s are more than a quarter
  EXPECT_EQ(result["outages"][0]["duration_s"], 5.0);
  EXPECT_EQ(result["outages"][1]["duration_s"], 40.0);
  for (const auto& outage : result["outages"]) {
    const bool longer = outage["duration_s"] == 40.0;  // than what is left at 330 s
    EXPECT_EQ(outage["starts_s"],
              longer ? nlohmann::json({120.0, 190.0, 260.0}) : nlohmann::json({120.0, 190.0, 260.0, 330.0}));
    ASSERT_EQ(outage["runs"].size(), 1U);
    EXPECT_EQ(outage["runs"][0]["truth"], "test");
    EXPECT_TRUE(outage["paired"].empty());
    std::size_t outages = 0;
    for (const auto& part : outage["runs"][0]["manoeuvres"]) outages += part["outages"].get<std::size_t>();
    EXPECT_EQ(outages, 2 * outage["starts_s"].size());
  }
  const auto rows = outage_rows(out);
  ASSERT_EQ(rows.size(), 14U);  // start by start, seed by seed
  EXPECT_EQ(rows[3].at("start_s"), "190");
  EXPECT_EQ(rows[3].at("seed"), "4");
  const auto page = nlohmann::json::parse(text_of(out / "report.json"));
  EXPECT_EQ(empty_plots(page), (std::vector<std::string>{}));
}

TEST(OutageStudy, SmoothsAsABatchWhereAsked) {
  const test::TemporaryDirectory folder;
  const fs::path study =
      ensemble_study(folder.path(),
                     "outages: [{start_s: 150, duration_s: 15}]\nerror_models:\n  - {name: rts, file: model.yaml}\n"
                     "  - {name: batch, file: model.yaml, smoother: batch}\n");
  const auto result = studied(study, folder.path() / "out", folder.path());
  const auto& runs = result["outages"][0]["runs"];
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[1]["error_model"], "batch");
  EXPECT_EQ(runs[0]["smoothed"]["share_inside_95"], runs[1]["smoothed"]["share_inside_95"]);
  for (const char* axis : {"n", "e", "d"}) {
    const auto& rts = runs[0]["smoothed"]["largest"][axis];
    const auto& batch = runs[1]["smoothed"]["largest"][axis];
    // The same optimum but for the linearisation: of second order in errors that are a few sigmas of 1e-3 rad.
    EXPECT_NEAR(batch["max_m"].get<double>(), rts["max_m"].get<double>(), 0.01 * rts["predicted_rms_m"].get<double>());
    EXPECT_NEAR(batch["predicted_rms_m"].get<double>(), rts["predicted_rms_m"].get<double>(),
                1e-3 * rts["predicted_rms_m"].get<double>());
  }
  EXPECT_NE(runs[0]["smoothed"]["largest"]["n"]["max_m"], runs[1]["smoothed"]["largest"]["n"]["max_m"]);
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::istringstream text(text_of(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

/// Interrupts a study in the middle of a line of its journal, goes on, and expects what one has that was never interrupted.
void expect_to_go_on(const fs::path& study, const fs::path& folder) {
  const fs::path whole = folder / "whole", cut = folder / "cut";
  static_cast<void>(studied(study, whole, folder));
  // No file may grow beyond some kilobytes: the program is killed as a full disk would stop it, after some lines.
  const std::string command = fmt::format("ulimit -c 0; ulimit -f 6; '{}' outage '{}' --out '{}' --quiet 2>'{}'", COAST_PROGRAM,
                                          study.string(), cut.string(), (folder / "killed.txt").string());
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_FALSE(fs::exists(cut / "outage.json"));
  ASSERT_TRUE(fs::exists(cut / "outages.partial")) << text_of(folder / "killed.txt");
  EXPECT_FALSE(text_of(cut / "outages.partial").ends_with('\n'));
  const std::size_t known = lines_of(cut / "outages.partial").size() - 2;  // without the first line and the one cut off
  ASSERT_GE(known, 2U);

  const Outcome outcome = run(fmt::format("outage '{}' --out '{}'", study.string(), cut.string()), folder);
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const std::string said = text_of(folder / "stdout.txt");
  EXPECT_NE(said.find(fmt::format("going on from {} outages", known)), std::string::npos) << said;
  for (const char* file : {"outage.json", "outages.csv", "report.json"})
    EXPECT_EQ(text_of(cut / file), text_of(whole / file)) << file;
  EXPECT_FALSE(fs::exists(cut / "outages.partial"));
}

TEST(OutageStudy, GoesOnWhereSeedsWereInterrupted) {
  const test::TemporaryDirectory folder;
  expect_to_go_on(ensemble_study(folder.path(), "sweep: {every_s: 70, first_s: 120, durations_s: [5, 10]}\n"), folder.path());
}

TEST(OutageStudy, GoesOnWhereASweepWasInterruptedButNotWithAnotherStudy) {
  const test::TemporaryDirectory folder;
  const std::string model = (studied_drive() / "error_model.yaml").string();
  const std::string models = fmt::format("  - {{name: own, file: {}}}\n", model);
  const fs::path study = recording_study(folder.path(), models);
  expect_to_go_on(study, folder.path());
  // What another study has left says nothing of this one.
  const fs::path out = folder.path() / "other";
  fs::create_directories(out);
  write(out / "outages.partial", fmt::format("coast {} outages 0123456789abcdef\n0,0,1 turn,1\n", COAST_VERSION));
  ASSERT_EQ(run(fmt::format("outage '{}' --out '{}'", study.string(), out.string()), folder.path()).status, 0);
  EXPECT_EQ(text_of(folder.path() / "stdout.txt").find("going on"), std::string::npos);
  EXPECT_EQ(text_of(out / "outage.json"), text_of(folder.path() / "whole" / "outage.json"));
}

struct SpoiledStudy {
  const char* what;
  const char* from;
  const char* to;
  const char* message;
};
class SpoiledStudies : public testing::TestWithParam<SpoiledStudy> {};

TEST_P(SpoiledStudies, EndWithStatusTwoAndNameTheLine) {
  const test::TemporaryDirectory folder;
  const fs::path study = shipped_study("straight_130s.yaml", folder.path(), "2");
  std::string text = text_of(study);
  const auto at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(GetParam().from).size(), GetParam().to);
  write(study, text);
  const Outcome outcome = run(fmt::format("outage '{}'", study.string()), folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.error;
  EXPECT_NE(outcome.error.find("straight_130s.yaml:"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find(GetParam().message), std::string::npos) << outcome.error;
}

INSTANTIATE_TEST_SUITE_P(
    Commands, SpoiledStudies,
    testing::Values(
        SpoiledStudy{"one seed has no pair", "count: 2", "count: 1", "at least 2"},
        SpoiledStudy{"a negative seed", "first: 1", "first: -1", "at least 0"},
        SpoiledStudy{"an unknown key", "floors:", "flors:", "flors"},
        SpoiledStudy{"a run beside a scenario", "truths:", "run: run.yaml\ntruths:", "run"},
        SpoiledStudy{"an outage beyond the end", "truths:", "outages: [{start_s: 880, duration_s: 130}]\ntruths:", "900 s"},
        SpoiledStudy{"an outage of nothing", "truths:", "outages: [{start_s: 300, duration_s: 0}]\ntruths:", "above zero"},
        SpoiledStudy{"a sweep beside a list", "truths:",
                     "outages: [{start_s: 300, duration_s: 9}]\nsweep: {durations_s: [9]}\ntruths:", "one of the two"},
        SpoiledStudy{"a sweep too long", "truths:", "sweep: {durations_s: [230]}\ntruths:", "no outage fits"},
        SpoiledStudy{"satellites of fixes", "truths:", "sweep: {durations_s: [9], satellites: 4}\ntruths:", "satellites"},
        SpoiledStudy{"noise of simulated sensors", "error_models:\n  - {", "error_models:\n  - {noise: estimated, ", "noise"},
        SpoiledStudy{"an unknown smoother", "error_models:\n  - {", "error_models:\n  - {smoother: best, ", "batch"}),
    [](const testing::TestParamInfo<SpoiledStudy>& spoiled) { return fmt::format("n{}", spoiled.index); });

}  // namespace
}  // namespace coast::cli
