// What a job tells of its progress where standard error is no terminal.

#include "progress.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "program.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

using std::chrono::milliseconds;

std::size_t times(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

/// What a job leaves on standard error.
std::string told_by(bool quiet, milliseconds every, const std::function<void(ProgressLine&)>& job) {
  testing::internal::CaptureStderr();
  {
    ProgressLine line(quiet, every);
    job(line);
  }
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, EachStageIsToldWhereItBeginsFirst) {
  const std::string told = told_by(false, std::chrono::seconds(30), [](ProgressLine& line) {
    for (int round = 0; round < 3; ++round)
      for (const char* stage : {"filtering forward", "smoothing backward"})
        for (int i = 0; i <= 10; ++i) line.show(stage, 0.1 * i);
  });
  EXPECT_EQ(times(told, "filtering forward"), 1U) << told;
  EXPECT_EQ(times(told, "smoothing backward"), 1U) << told;
  EXPECT_EQ(times(told, "\n"), 2U) << told;
  EXPECT_EQ(times(told, "\r"), 0U) << told;
}

TEST(Progress, AStepThatDoesNotCallIsToldRegularlyWithTheTimeLeft) {
  const std::string told = told_by(false, milliseconds(400), [](ProgressLine& line) {
    line.show("estimating", 0.0);
    std::this_thread::sleep_for(milliseconds(1100));
    line.show("estimating", 0.5);  // as long again
    std::this_thread::sleep_for(milliseconds(450));
  });
  EXPECT_GE(times(told, "estimating\n"), 2U) << told;
  EXPECT_GE(times(told, "estimating 50 %, 1 s left\n"), 1U) << told;
}

TEST(Progress, QuietTellsNothing) {
  EXPECT_EQ(told_by(true, milliseconds(1),
                    [](ProgressLine& line) {
                      line.show("estimating", 0.0);
                      std::this_thread::sleep_for(milliseconds(20));
                    }),
            "");
}

TEST(Progress, JobsTellTheirStages) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path run_yaml = simulated_recording(test::kShortDrive, folder.path()) / "run.yaml";
  write(folder.path() / "study.yaml",
        "schema: coast.study/1\nrun: rec/run.yaml\nsweep: {every_s: 60, first_s: 100, durations_s: [10]}\n"
        "error_models:\n  - {name: test, file: model.yaml}\n");
  const std::string here = folder.path().string();
  for (const auto& [command, stages] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"process '{0}/rec/run.yaml'", {"reading", "filtering forward", "smoothing backward", "writing"}},
           {"outage '{0}/study.yaml'", {"reading", "filtering forward", "outages with test", "writing"}},
           {"diagnose '{0}/rec/run.yaml' --twins 0", {"reading", "examining effects", "writing"}}}) {
    const std::string job = fmt::format(fmt::runtime(command), here);
    const Outcome outcome = run(fmt::format("{} --out '{}/out'", job, here), folder.path());
    EXPECT_EQ(outcome.status, 0) << job << outcome.error;
    for (const std::string& stage : stages) EXPECT_GE(times(outcome.error, " s: " + stage), 1U) << job << outcome.error;
    const Outcome quiet = run(fmt::format("{} --out '{}/out' --quiet", job, here), folder.path());
    EXPECT_EQ(times(quiet.error, " s: "), 0U) << job << quiet.error;
    std::filesystem::remove_all(folder.path() / "out");
  }
}

}  // namespace
}  // namespace coast::cli
