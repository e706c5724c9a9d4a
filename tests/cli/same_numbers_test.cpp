// The program and the jobs behind it: one and the same numbers.

#include <gtest/gtest.h>

#include "coast/io/reference.hpp"
#include "coast/jobs/process.hpp"
#include "program.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

TEST(SameNumbers, OfAProcessedMissionInMemory) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path run_yaml = simulated_recording(test::kShortDrive, folder.path()) / "run.yaml";
  const std::filesystem::path written = folder.path() / "written";
  const Outcome outcome = run(fmt::format("process '{}' --out '{}'", run_yaml.string(), written.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;

  const jobs::RunConfig config = jobs::read_run_config(run_yaml);
  const jobs::ProcessedMission mission = jobs::process(config, jobs::load(config, {}), jobs::Progress{});
  const std::filesystem::path again = jobs::results_folder(run_yaml, folder.path() / "again", jobs::files_of(config));
  jobs::write(config, mission.result, again);
  for (const char* file : {"summary.json", "innovations.csv", "run.resolved.yaml", "report.json"})
    EXPECT_TRUE(text_of(written / file) == text_of(again / file)) << file;
  const record::Trajectory delivered = io::read_reference(io::ReferenceFileOptions::of_file(written / "trajectory.nav"));
  ASSERT_EQ(delivered.states.size(), mission.delivered.size());
  for (std::size_t i = 0; i < delivered.states.size(); i += 100)  // digits of the file: 1e-11 deg, 1e-4 m of height
    EXPECT_LT((delivered.states[i].r_eb_e - mission.delivered[i].nav.r_eb_e).norm(), 1e-4);
}

}  // namespace
}  // namespace coast::cli
