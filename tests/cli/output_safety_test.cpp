// What the program leaves alone, and what it leaves behind: files of others, half files, lost output.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "program.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTable =
    "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n1,0,0,0,0,0,-9.8\n";

bool says(const Outcome& outcome, const std::string& words) {
  return outcome.error.find(words) != std::string::npos;
}

Outcome simulated_again(const fs::path& folder) {
  return run(fmt::format("simulate '{}' --out '{}'", (folder / "scenario.yaml").string(), (folder / "rec").string()), folder);
}

/// A process number that was in use and is not any more.
pid_t dead_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return child;
}

std::vector<std::string> parts_in(const fs::path& folder) {
  std::vector<std::string> parts;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const std::string name = entry.path().filename().string(); name.find(".part-") != std::string::npos)
      parts.push_back(name);
  return parts;
}

TEST(OutputSafety, SimulateLeavesAnImuFileOfTheUserAlone) {
  const test::TemporaryDirectory folder;
  fs::create_directories(folder.path() / "rec");
  write(folder.path() / "rec" / "imu.csv", kTable);
  write(folder.path() / "scenario.yaml", test::kShortDrive);
  write(folder.path() / "model.yaml", test::kTestModel);
  const Outcome outcome = simulated_again(folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(says(outcome, "rec/imu.csv: this file would be replaced")) << outcome.error;
  EXPECT_EQ(text_of(folder.path() / "rec" / "imu.csv"), kTable);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "rec"), fs::directory_iterator()), 1);
}

TEST(OutputSafety, ReplacesWhatItWroteItselfUnlessItWasChanged) {
  const test::TemporaryDirectory folder;
  const fs::path made = simulated_recording(test::kShortDrive, folder.path());
  EXPECT_EQ(simulated_again(folder.path()).status, 0);
  fs::remove(made / ".coast-results");  // as an earlier version left it
  const Outcome unmarked = simulated_again(folder.path());
  EXPECT_EQ(unmarked.status, 0) << unmarked.error;
  write(made / "run.yaml", text_of(made / "run.yaml") + "vehicle: car\n");
  const Outcome changed = simulated_again(folder.path());
  EXPECT_EQ(changed.status, 2);
  EXPECT_TRUE(says(changed, "rec/run.yaml")) << changed.error;
}

TEST(OutputSafety, NoJobReplacesItsInput) {
  const test::TemporaryDirectory folder;
  const std::string here = folder.path().string();
  const fs::path made = simulated_recording(test::kShortDrive, folder.path());
  const std::string imu = text_of(made / "imu.csv");
  write(made / "pair.yaml",
        "schema: coast.array/1\nimus:\n  - {name: a, file: imu.csv, gps_week: 2374, error_model: error_model.yaml}\n"
        "  - {name: b, file: imu.csv, gps_week: 2374, error_model: error_model.yaml}\n");
  const Outcome synth = run(fmt::format("synth '{0}/rec/pair.yaml' --out '{0}/rec'", here), folder.path());
  EXPECT_EQ(synth.status, 2);
  EXPECT_TRUE(says(synth, "imu.csv: an input of this job")) << synth.error;
  EXPECT_EQ(text_of(made / "imu.csv"), imu);

  write(folder.path() / "imu.csv", imu);
  write(folder.path() / "error_model.yaml", test::kTestModel);
  const Outcome calibrate = run(fmt::format("calibrate '{0}/imu.csv' --out '{0}'", here), folder.path());
  EXPECT_EQ(calibrate.status, 2);
  EXPECT_TRUE(says(calibrate, "error_model.yaml: this file would be replaced")) << calibrate.error;
  EXPECT_EQ(text_of(folder.path() / "error_model.yaml"), test::kTestModel);
}

TEST(OutputSafety, LostOutputIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const test::TemporaryDirectory folder;
  const fs::path truth = simulated_recording(test::kShortDrive, folder.path()) / "truth.nav";
  const std::string compare = fmt::format("compare '{0}' '{0}'", truth.string());
  for (const std::string& command : {std::string("--help"), compare})
    for (const char* lost : {">/dev/full", ">&-"}) {
      const fs::path log = folder.path() / "log.txt";
      const int status = std::system(fmt::format("'{}' {} {} 2>'{}'", COAST_PROGRAM, command, lost, log.string()).c_str());
      EXPECT_EQ(WEXITSTATUS(status), 1) << command << lost;
      EXPECT_NE(text_of(log).find("standard output"), std::string::npos) << text_of(log);
    }
  EXPECT_EQ(run(compare, folder.path()).status, 0);
}

TEST(OutputSafety, TheNextRunRemovesThePartsOfDeadProcesses) {
  const test::TemporaryDirectory folder;
  const fs::path made = simulated_recording(test::kShortDrive, folder.path());
  const std::string dead = fmt::format(".part-{}", dead_process());
  const std::string alive = fmt::format("imu.csv.part-{}", ::getpid());
  for (const std::string& name : {"imu.csv" + dead, "mine.csv" + dead, alive}) write(made / name, "half");
  ASSERT_EQ(simulated_again(folder.path()).status, 0);
  const std::vector<std::string> left = parts_in(made);
  EXPECT_EQ(left.size(), 2U);
  EXPECT_EQ(std::ranges::count(left, alive), 1);
  EXPECT_EQ(std::ranges::count(left, "mine.csv" + dead), 1);  // not a name that coast has written here
}

TEST(OutputSafety, AnInterruptedRunLeavesNoParts) {
  const test::TemporaryDirectory folder;
  std::string text = test::kShortDrive;
  text.replace(text.find("duration_s: 220"), 15, "duration_s: 6000");
  write(folder.path() / "scenario.yaml", text);
  write(folder.path() / "model.yaml", test::kTestModel);
  const std::string out = (folder.path() / "rec").string();
  const std::string log = (folder.path() / "log.txt").string();
  // Ends it as soon as a part is there.
  const std::string script = fmt::format(
      "'{0}' simulate '{1}/scenario.yaml' --out '{2}' >/dev/null 2>'{3}' & p=$!; "
      "while kill -0 $p 2>/dev/null && ! ls '{2}'/*.part-* >/dev/null 2>&1; do :; done; kill -TERM $p; wait $p",
      COAST_PROGRAM, folder.path().string(), out, log);
  const int status = std::system(script.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM) << text_of(log);
  EXPECT_NE(text_of(log).find("interrupted"), std::string::npos) << text_of(log);
  EXPECT_TRUE(parts_in(out).empty());
  EXPECT_FALSE(fs::exists(fs::path(out) / "run.yaml"));
}

/// Runs a job again over its results and ends it, as `kill -9` does, when its trajectory is new and its summary is not written.
int killed_between_results(const std::string& job, const fs::path& out, const fs::path& log) {
  const std::string script = fmt::format(
      "'{0}' {1} >'{3}' 2>&1 & p=$!; while kill -0 $p 2>/dev/null && [ -e '{2}/summary.json' ]; do :; done; "
      "while kill -0 $p 2>/dev/null && ls '{2}'/trajectory.nav.part-* >/dev/null 2>&1; do :; done; kill -KILL $p; wait $p",
      COAST_PROGRAM, job, out.string(), log.string());
  return WEXITSTATUS(std::system(script.c_str()));
}

TEST(OutputSafety, ResultsOfTwoRunsAreKnown) {
  const test::TemporaryDirectory folder;
  const fs::path made = simulated_recording(test::kShortDrive, folder.path());
  const fs::path out = folder.path() / "out";
  write(made / "sweep.yaml", text_of(made / "run.yaml") + "outages: {every_s: 2, first_s: 60, durations_s: [10, 20, 30]}\n");
  const std::string job = fmt::format("process '{}' --out '{}'", (made / "sweep.yaml").string(), out.string());
  const std::string report = fmt::format("report '{}'", out.string());
  const std::string compare =
      fmt::format("compare '{}' '{}'", (out / "trajectory.nav").string(), (made / "truth.nav").string());
  ASSERT_EQ(run(job, folder.path()).status, 0);
  EXPECT_EQ(run(report, folder.path()).status, 0);
  EXPECT_FALSE(says(run(compare, folder.path()), "interrupted"));

  const fs::path log = folder.path() / "log.txt";
  ASSERT_EQ(killed_between_results(job, out, log), 128 + SIGKILL) << text_of(log);
  ASSERT_TRUE(fs::exists(out / "trajectory.nav"));
  EXPECT_FALSE(fs::exists(out / "summary.json"));
  const Outcome refused = run(report, folder.path());
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(says(refused, "interrupted before it wrote summary.json")) << refused.error;
  const Outcome warned = run(compare, folder.path());
  EXPECT_EQ(warned.status, 0);
  EXPECT_TRUE(says(warned, "trajectory.nav: the run was interrupted before it wrote summary.json")) << warned.error;

  ASSERT_EQ(run(job, folder.path()).status, 0);
  EXPECT_TRUE(parts_in(out).empty());
  EXPECT_EQ(run(report, folder.path()).status, 0);
  EXPECT_FALSE(says(run(compare, folder.path()), "interrupted"));
}

/// A job that ends with an error between two of its files leaves its set open, like one that was killed.
TEST(OutputSafety, EveryJobWritesTheFileThatClosesItsResultsLast) {
  const test::TemporaryDirectory folder;
  const std::string here = folder.path().string();
  const fs::path made = simulated_recording(test::kShortDrive, folder.path());
  write(folder.path() / "study.yaml",
        "schema: coast.study/1\nrun: rec/run.yaml\nsweep: {every_s: 60, first_s: 100, durations_s: [10]}\n"
        "error_models:\n  - {name: test, file: model.yaml}\n");
  for (const auto& [job, closing] : std::vector<std::pair<std::string, std::string>>{
           {fmt::format("process '{}/rec/run.yaml'", here), "summary.json"},
           {fmt::format("outage '{}/study.yaml'", here), "outage.json"},
           {fmt::format("diagnose '{}/rec/run.yaml' --twins 0", here), "diagnosis.json"}}) {
    const fs::path out = folder.path() / closing;
    const std::string to_out = fmt::format("{} --out '{}'", job, out.string());
    fs::create_directories(out / "report.html");  // no file can take its place
    EXPECT_EQ(run(to_out, folder.path()).status, 1) << job;
    EXPECT_FALSE(fs::exists(out / closing)) << job;
    EXPECT_TRUE(says(run(fmt::format("report '{}'", out.string()), folder.path()), "before it wrote " + closing)) << job;
    fs::remove(out / "report.html");
    EXPECT_EQ(run(to_out, folder.path()).status, 0) << job;
    EXPECT_EQ(run(fmt::format("report '{}'", out.string()), folder.path()).status, 0) << job;
  }
}

TEST(OutputSafety, NamesTheNearestSubcommand) {
  const test::TemporaryDirectory folder;
  const Outcome outcome = run("proces run.yaml", folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(says(outcome, "proces is no subcommand: did you mean process?")) << outcome.error;
  EXPECT_EQ(run("trajectory", folder.path()).status, 2);
  EXPECT_EQ(run("", folder.path()).status, 2);
}

TEST(OutputSafety, ReportMakesTheFolderThatItIsGiven) {
  const test::TemporaryDirectory folder;
  const std::string here = folder.path().string();
  write(folder.path() / "report.json", R"({"schema": "coast.page/1", "title": "a page", "sections": []})");
  const Outcome outcome = run(fmt::format("report '{0}' --out '{0}/new/page'", here), folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_TRUE(fs::exists(folder.path() / "new" / "page" / "report.html"));
}

struct OtherFile {
  const char* content;
  const char* named;
};

class OtherKinds : public testing::TestWithParam<OtherFile> {};

TEST_P(OtherKinds, AreNamedWhereATableOrARunFileIsExpected) {
  const test::TemporaryDirectory folder;
  const auto [content, named] = GetParam();
  write(folder.path() / "other", content);
  write(folder.path() / "imu.csv", kTable);
  write(folder.path() / "model.yaml", test::kTestModel);
  const auto expect_named = [&, word = named](const std::string& file) {
    const Outcome outcome = run(fmt::format("process '{}'", (folder.path() / file).string()), folder.path());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(says(outcome, fmt::format("other: this is {}", word))) << outcome.error;
  };
  expect_named("other");
  write(folder.path() / "imu.yaml",
        "imu: {file: other, format: csv, gps_week: 2374, error_model: model.yaml, lever_arm_m: [0, 0, 0]}\n"
        "gnss: {file: imu.csv, format: csv, gps_week: 2374}\n");
  write(folder.path() / "gnss.yaml",
        "imu: {file: imu.csv, format: csv, gps_week: 2374, error_model: model.yaml, lever_arm_m: [0, 0, 0]}\n"
        "gnss: {file: other, format: csv, gps_week: 2374}\n");
  if (std::string_view(named) != "a table of an IMU") expect_named("gnss.yaml");
}

INSTANTIATE_TEST_SUITE_P(
    Files, OtherKinds,
    testing::Values(OtherFile{"$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\n", "an NMEA file"},
                    OtherFile{"     3.04           OBSERVATION DATA    M: MIXED            RINEX VERSION / TYPE\n",
                              "a RINEX file"},
                    OtherFile{"\xb5\x62\x01\x07\x5c\x01\x02\x03", "a UBX file"}, OtherFile{"PK\x03\x04zip", "a zip archive"},
                    OtherFile{kTable, "a table of an IMU"}),
    [](const testing::TestParamInfo<OtherFile>& file) { return fmt::format("n{}", file.index); });

TEST(OutputSafety, AStudyGivenToProcessIsNamedWithItsSubcommand) {
  const test::TemporaryDirectory folder;
  write(folder.path() / "study.yaml", "schema: coast.study/1\nscenario: scenario.yaml\n");
  const Outcome outcome = run(fmt::format("process '{}'", (folder.path() / "study.yaml").string()), folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(says(outcome, "this file is a study of outages")) << outcome.error;
  EXPECT_TRUE(says(outcome, "coast outage")) << outcome.error;
}

}  // namespace
}  // namespace coast::cli
